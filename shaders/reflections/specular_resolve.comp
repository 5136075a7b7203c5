#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Adds the light of punctual lights whose shadow rays from specular hits are not occluded.
#include "lib/denoise/moments.glsl"
#include "lib/rays/ray_index.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Occluded { uint occluded[]; };
layout(set = 1, binding = 3, rgba32f) uniform image2D radiance;
layout(push_constant) uniform Constants { int scale; };

void main() {
  uint index = ray_index();
  if (index >= ray_count.count || occluded[index] != 0u) return;
  Ray ray = rays[index];
  ivec2 cell = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u) / scale;
  vec3 light = uintBitsToFloat(uvec3(ray.user, ray.padding0, ray.padding1));
  imageStore(radiance, cell, imageLoad(radiance, cell) + vec4(sanitize(light), 0.0));
}
