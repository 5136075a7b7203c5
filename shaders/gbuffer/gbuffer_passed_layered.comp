#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define GBUFFER_LAYERED
#include "lib/scene/gbuffer_passed.glsl"
