#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;

#define ANY_HIT false
#define BVH_BINDING 2
#include "lib/rays/bvh.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 5, std430) writeonly buffer Hits { StoredHit hits[]; };
layout(push_constant) uniform Constants { uint root; };

void main() {
  const uint index = traced_ray(ray_count.count);
  if (index == not_traced) return;
  hits[index] = stored(trace(rays[index], root, ray_count.blending));
}
