#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// Adds to blended surfaces the light that has come through them along a ray of each pixel, and
// empties the image that had it; or leaves it there for blended_bands.comp. Rays that met nothing
// see what the camera sees there.
#include "lib/denoise/moments.glsl"
#include "lib/lighting/environment.glsl"
#include "lib/rays/specular_pixels.glsl"
#include "shared/ray.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, rgba32f) uniform image2D radiance;
layout(set = 1, binding = 3, rgba32f) uniform image2D specular;  // a: how far the rays went
layout(push_constant) uniform Constants { uint leaves; };

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  Ray ray = rays[index];
  ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
  vec4 met = imageLoad(specular, pixel);
  vec3 light = met.rgb;
  if (met.a >= distance_of_misses) {
    vec3 weight = uintBitsToFloat(uvec3(ray.user, ray.padding0, ray.padding1));
    light = weight * environment_background(ray.direction);
  }
  light = sanitize(light);
  if (leaves != 0u) {
    imageStore(specular, pixel, vec4(light, met.a));
    return;
  }
  vec4 sum = imageLoad(radiance, pixel);
  imageStore(radiance, pixel, vec4(sum.rgb + light, sum.a));
  imageStore(specular, pixel, vec4(0.0));
}
