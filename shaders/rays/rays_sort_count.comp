#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Counting sort of a ray stream, first: how many rays have each key.
#include "lib/rays/ray_index.glsl"
#include "lib/rays/ray_key.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) buffer Offsets { uint offsets[]; };

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  atomicAdd(offsets[ray_key(rays[index].origin, rays[index].direction)], 1u);
}
