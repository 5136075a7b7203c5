#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// Empties an image at the pixels of rays.
#include "shared/ray.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, rgba32f) writeonly uniform image2D emptied;

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  uint pixel = rays[index].pixel;
  imageStore(emptied, ivec2(pixel & 0xffffu, pixel >> 16u), vec4(0.0));
}
