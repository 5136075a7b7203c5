#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Nothing is drawn yet where gbuffer_small.comp and gbuffer_large.comp draw. An invocation for each
// four pixels.
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(set = 1, binding = 0, std430) writeonly buffer Nearest { uint64_t nearest[]; };
layout(set = 1, binding = 1, std430) writeonly buffer Parts {
  uint part_count;
  uint trace_groups[3];
};

void main() {
  const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  const uint index = group * 64u + gl_LocalInvocationIndex;
  const uint invocations = gl_NumWorkGroups.x * gl_NumWorkGroups.y * 64u;
  if (index == 0u) {
    part_count = 0u;
    trace_groups = uint[3](0u, 1u, 1u);
  }
  for (uint i = 0u; i < 4u; ++i) {
    const uint at = index + i * invocations;
    if (at < uint(nearest.length())) nearest[at] = ~uint64_t(0);
  }
}
