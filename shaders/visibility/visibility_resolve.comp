#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// Brings the answers of a stream of visibility rays back to their pixels.
layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Occluded { uint occluded[]; };
layout(set = 1, binding = 3, r32f) writeonly uniform image2D visibility;

void main() {
  uint index = ray_index();
  if (index >= ray_count.count || occluded[index] == 0u) return;
  uint pixel = rays[index].pixel;
  imageStore(visibility, ivec2(pixel & 0xffffu, pixel >> 16u), vec4(0.0));
}
