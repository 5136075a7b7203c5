#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;

#define ANY_HIT false
#include "lib/rays/bvh.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 5, std430) writeonly buffer Hits { StoredHit hits[]; };

void main() {
  const uint index = traced_ray(ray_count.count);
  if (index == not_traced) return;
  hits[index] = stored(trace(rays[index]));
}
