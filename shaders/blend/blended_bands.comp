#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/rays/ray_index.glsl"
layout(local_size_x = 64) in;
// Adds to blended surfaces the light that has come through them, in scenes whose volumes split it
// into its colours. A pixel's ray has one band of wavelengths there: the others are those of the
// pixels around it, as the colours of a camera's filter mosaic are. Alone, a third of the samples
// would be red, and what weighs samples by their brightness would tint the glass.
#include "lib/lighting/transmission.glsl"
#include "shared/ray.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Chosen { Hit chosen[]; };  // by pixel
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D through;  // a: 0: no ray
layout(set = 1, binding = 4, rgba32f) uniform image2D radiance;

Hit chosen_at(ivec2 pixel) { return chosen[uint(pixel.y) * frame.extent.x + uint(pixel.x)]; }

/// 1 for the colour of a band.
vec3 color_of(uint band) { return vec3(equal(uvec3(1u, 2u, 3u), uvec3(band))); }

/// `light` of one band, that stands for all three, with the others of the same instance around it;
/// as it is where some are missing.
vec3 with_other_bands(vec3 light, uint medium, uint own, uint instance, ivec2 pixel) {
  vec3 sum = light, count = color_of(own);
  for (int i = 0; i < 9; ++i) {
    ivec2 at = pixel + ivec2(i % 3, i / 3) - 1;
    if (any(lessThan(at, ivec2(0))) || outside_frame(at)) continue;
    uint band = pixel_band(medium, at);
    if (band == own) continue;
    vec4 near = imageLoad(through, at);
    if (near.a <= 0.0 || chosen_at(at).instance != instance) continue;
    sum += near.rgb;
    count += color_of(band);
  }
  return all(greaterThan(count, vec3(0.0))) ? sum / (3.0 * count) : light;
}

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  uint packed = rays[index].pixel;
  ivec2 pixel = ivec2(packed & 0xffffu, packed >> 16u);
  vec3 light = imageLoad(through, pixel).rgb;
  Hit hit = chosen_at(pixel);
  uint medium = layer_number(hit);
  uint band = layers[medium].refraction == 0.0 ? 0u : pixel_band(medium, pixel);
  if (band != 0u) light = with_other_bands(light, medium, band, hit.instance, pixel);
  vec4 sum = imageLoad(radiance, pixel);
  imageStore(radiance, pixel, vec4(sum.rgb + light, sum.a));
}
