// Which rays a blended surface stops is decided by the ray's own bits: tracers agree on it, and a ray
// that is traced twice meets the same.
#ifndef HELIOGRAPH_RAY_BLENDING_GLSL
#define HELIOGRAPH_RAY_BLENDING_GLSL
#include "shared/ray.h"
#include "shared/ray_mask.h"

/// `blending` of the ray's stream; the same in server/tracing/bvh/alpha_mask.cpp.
uint ray_blending(Ray ray, uint blending) {
  if (blending == 0u) return 0u;
  uvec3 direction = floatBitsToUint(ray.direction);
  uvec3 origin = floatBitsToUint(ray.origin);
  uint bits = mixed_bits(blending ^ direction.x);
  bits = mixed_bits(bits ^ direction.y);
  bits = mixed_bits(bits ^ direction.z);
  bits = mixed_bits(bits ^ origin.x);
  bits = mixed_bits(bits ^ origin.y);
  return mixed_bits(bits ^ origin.z) | 1u;
}

#endif
