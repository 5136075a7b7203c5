#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;

#define ANY_HIT true
#include "lib/rays/bvh.glsl"

layout(set = 1, binding = 5, std430) writeonly buffer Occluded { uint occluded[]; };

void main() {
  const uint index = traced_ray(ray_count.count);
  if (index == not_traced) return;
  occluded[index] = trace(rays[index]).instance != hit_none ? 1u : 0u;
}
