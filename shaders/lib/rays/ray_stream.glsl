// Appending rays to a stream: one global atomic per workgroup. Include after declaring the
// workgroup size; rays need bindings `ray_count` and `rays` in the pass set.
#ifndef HELIOGRAPH_RAY_STREAM_GLSL
#define HELIOGRAPH_RAY_STREAM_GLSL
#include "lib/rays/ray_index.glsl"
#include "lib/rays/stored_rays.glsl"

shared uint group_rays;
shared uint group_base;

#define APPEND_RAY(requested, ray) APPEND_RAY_TO(ray_count, rays, requested, ray)

/// For passes with several streams.
#define APPEND_RAY_TO(ray_count, rays, requested, ray)                                 \
  {                                                                                 \
    if (gl_LocalInvocationIndex == 0u) group_rays = 0u;                             \
    barrier();                                                                      \
    uint slot = (requested) ? atomicAdd(group_rays, 1u) : 0u;                          \
    barrier();                                                                      \
    if (gl_LocalInvocationIndex == 0u && group_rays > 0u) {                         \
      group_base = atomicAdd(ray_count.count, group_rays);                          \
      uint groups = (group_base + group_rays - 1u) / rays_per_group + 1u;           \
      atomicMax(ray_count.groups_x, min(groups, groups_per_row));                   \
      atomicMax(ray_count.groups_y, rows_of(groups));                               \
      uint tracing = tracing_groups(group_base + group_rays);                       \
      atomicMax(ray_count.tracing_groups_x, min(tracing, groups_per_row));          \
      atomicMax(ray_count.tracing_groups_y, rows_of(tracing));                      \
    }                                                                               \
    barrier();                                                                      \
    if (requested) rays[group_base + slot] = stored(ray);                            \
  }

#endif
