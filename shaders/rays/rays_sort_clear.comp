#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Counting sort of a ray stream, before it: no ray has any key.
#include "shared/ray_sorting.h"

layout(set = 1, binding = 0, std430) writeonly buffer Offsets { uint offsets[]; };

void main() {
  if (gl_GlobalInvocationID.x < ray_keys) offsets[gl_GlobalInvocationID.x] = 0u;
}
