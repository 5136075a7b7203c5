#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Cuts the intervals of a stream's rays to what section planes leave of them.
#include "lib/rays/ray_index.glsl"
#include "lib/rays/section.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) buffer Rays { Ray rays[]; };

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  float t_min = rays[index].t_min, t_max = rays[index].t_max;
  if (t_min >= t_max) return;
  int entered;
  vec2 kept = kept_interval(rays[index].origin, rays[index].direction, entered);
  kept = vec2(max(kept.x, t_min), min(kept.y, t_max));
  // A ray of which nothing is left goes on to where nothing is: one without any interval would not
  // be a ray, and find no background.
  if (kept.x >= kept.y) kept = vec2(section_never, 2.0 * section_never);
  rays[index].t_min = kept.x;
  rays[index].t_max = kept.y;
}
