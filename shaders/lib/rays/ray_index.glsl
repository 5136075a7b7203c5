// The ray of an invocation, in passes of 64 x 1 invocations a group that a stream's own count starts.
#ifndef HELIOGRAPH_RAY_INDEX_GLSL
#define HELIOGRAPH_RAY_INDEX_GLSL
#include "shared/ray.h"

uint ray_index() { return gl_GlobalInvocationID.y * rays_per_row + gl_GlobalInvocationID.x; }

uint rows_of(uint groups) { return (groups + groups_per_row - 1u) / groups_per_row; }

const uint not_traced = 0xffffffffu;

/// The ray of an invocation of tracing_groups(count) groups, or not_traced. The rays of a group are
/// shared between its halves, which most devices run apart.
uint traced_ray(uint count) {
  uint groups = tracing_groups(count);
  uint of_group = (count + groups - 1u) / groups;
  uint of_half = (of_group + 1u) / 2u;
  uint lane = gl_LocalInvocationIndex % (rays_per_group / 2u);
  uint in_group = gl_LocalInvocationIndex / (rays_per_group / 2u) * of_half + lane;
  uint group = gl_WorkGroupID.y * groups_per_row + gl_WorkGroupID.x;
  uint index = group * of_group + in_group;
  return lane < of_half && in_group < of_group && index < count ? index : not_traced;
}

/// Of a stream that is full from the beginning.
RayCount full_stream(uint count, uint blending) {
  uint groups = (count + rays_per_group - 1u) / rays_per_group;
  uint tracing = tracing_groups(count);
  return RayCount(count, min(groups, groups_per_row), rows_of(groups), 1u, blending,
                  min(tracing, groups_per_row), rows_of(tracing), 1u);
}

#endif
