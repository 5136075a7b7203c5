#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Adds what came along rays that met nothing. A number that is none must not stay in the mean.
#include "lib/rays/reference_path.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 1, std430) readonly buffer Occluded { uint occluded[]; };
layout(set = 1, binding = 2, rgba32f) uniform image2D reference;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  uint index = pixel_index(pixel);
  vec3 sum = imageLoad(reference, pixel).rgb;
  if (occluded[index] == 0u) sum += carried(rays[index]);
  if (any(isnan(sum)) || any(isinf(sum))) sum = vec3(0.0);
  imageStore(reference, pixel, vec4(sum, 1.0));
}
