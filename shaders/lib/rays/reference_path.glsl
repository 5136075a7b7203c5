// What the passes of the reference path tracer share. Streams are dense: the ray of a pixel stands
// at the pixel's index, and a ray that is not requested has an empty interval, so that no pass ever
// writes another pixel's radiance.
#ifndef HELIOGRAPH_REFERENCE_PATH_GLSL
#define HELIOGRAPH_REFERENCE_PATH_GLSL
#include "lib/denoise/frame_blending.glsl"
#include "lib/scene/hit_material.glsl"
#include "lib/lighting/light_choice.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/math/sampling.glsl"
#include "shared/reference.h"

uint pixel_index(ivec2 pixel) { return uint(pixel.y) * frame.extent.x + uint(pixel.x); }

/// Of all pixels. `blending`: see RayCount.
RayCount dense_stream(uint blending) {
  return full_stream(frame.extent.x * frame.extent.y, blending);
}

Ray no_ray() { return Ray(vec3(0.0), 0.0, vec3(0.0, 0.0, 1.0), 0.0, 0u, 0u, 0u, 0u); }

bool is_wanted(Ray ray) { return ray.t_min < ray.t_max; }

Ray ray_from(vec3 position, vec3 normal, vec3 direction, float t_max) {
  return Ray(offset_origin(position, normal, 0.0), 0.0, direction, t_max, 0u, 0u, 0u, 0u);
}

/// The ray carries the radiance of the light, added where it is not occluded.
void carry(inout Ray ray, vec3 radiance) {
  uvec3 bits = floatBitsToUint(radiance);
  ray.user = bits.r;
  ray.padding0 = bits.g;
  ray.padding1 = bits.b;
}

vec3 carried(Ray ray) { return uintBitsToFloat(uvec3(ray.user, ray.padding0, ray.padding1)); }

/// Dimensions of the random sequences: 16 for each round, away from those of the hybrid.
uint dimension(uint round, uint which) { return 256u + 16u * round + which; }

vec2 path_pair(ivec2 pixel, uint round, uint which) {
  return random_pair(uvec2(pixel), frame.sample_index, dimension(round, which), frame.seed);
}

float path_number(ivec2 pixel, uint round, uint which) {
  return random_number(uvec2(pixel), frame.sample_index, dimension(round, which), frame.seed);
}

/// Whether a path goes straight on through a blended surface, `behind` which that fraction is seen;
/// its throughput becomes that of the way it takes.
bool passes_through(HitSurface s, vec3 behind, ivec2 pixel, uint round, inout vec3 throughput) {
  if (!scene_has(scene_blends) || !is_blended(s)) return false;
  float pass_probability = dot(behind, vec3(1.0 / 3.0));
  bool passes = path_number(pixel, round, 0u) < pass_probability;
  throughput *= passes ? behind / pass_probability : vec3(s.alpha / (1.0 - pass_probability));
  return passes;
}

#endif
