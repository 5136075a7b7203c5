#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require

#include "shared/ray.h"

layout(location = 0) rayPayloadInEXT Hit payload;

void main() { payload.instance = hit_none; }
