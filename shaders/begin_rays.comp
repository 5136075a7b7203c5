#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ray.h"
layout(local_size_x = 1) in;
// Empties a ray stream.
layout(set = 1, binding = 0, std430) writeonly buffer Count { RayCount ray_count; };

void main() { ray_count = RayCount(0u, 0u, 1u, 1u); }
