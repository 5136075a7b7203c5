// The ray of an invocation, in passes of 64 x 1 invocations a group that a stream's own count starts.
#ifndef HELIOGRAPH_RAY_INDEX_GLSL
#define HELIOGRAPH_RAY_INDEX_GLSL
#include "shared/ray.h"

uint ray_index() { return gl_GlobalInvocationID.y * rays_per_row + gl_GlobalInvocationID.x; }

/// Of a stream that is full from the beginning.
RayCount full_stream(uint count, uint blending) {
  uint groups = (count + rays_per_group - 1u) / rays_per_group;
  uint rows = (groups + groups_per_row - 1u) / groups_per_row;
  return RayCount(count, min(groups, groups_per_row), rows, 1u, blending, 0u, 0u, 0u);
}

#endif
