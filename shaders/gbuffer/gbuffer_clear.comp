#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Nothing is drawn or listed yet. An invocation for each four pixels.
#include "lib/rays/drawn_key.glsl"

layout(set = 1, binding = 0, std430) writeonly buffer Nearest { uint64_t nearest[]; };
layout(set = 1, binding = 1, std430) writeonly buffer Parts { uint part_count; };
layout(set = 1, binding = 2, std430) writeonly buffer Tiles { uint tile_count; };

void main() {
  const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  const uint index = group * 64u + gl_LocalInvocationIndex;
  const uint invocations = gl_NumWorkGroups.x * gl_NumWorkGroups.y * 64u;
  if (index == 0u) {
    part_count = 0u;
    tile_count = 0u;
  }
  for (uint i = 0u; i < 4u; ++i) {
    const uint at = index + i * invocations;
    if (at < uint(nearest.length())) nearest[at] = drawn_nothing;
  }
}
