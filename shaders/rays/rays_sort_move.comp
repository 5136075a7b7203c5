#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Counting sort of a ray stream, third: every ray to the next slot of its key.
#include "lib/rays/ray_index.glsl"
#include "lib/rays/ray_key.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) buffer Offsets { uint offsets[]; };
layout(set = 1, binding = 3, std430) writeonly buffer Sorted { StoredRay sorted[]; };

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  Ray ray = rays[index];
  sorted[atomicAdd(offsets[ray_key(ray.origin, ray.direction)], 1u)] = stored(ray);
}
