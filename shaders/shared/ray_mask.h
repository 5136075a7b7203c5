// Where rays pass through meshes: what tracers on the device and on the host decide alike.
#ifndef HELIOGRAPH_SHARED_RAY_MASK_H
#define HELIOGRAPH_SHARED_RAY_MASK_H
#include "types.h"
SHARED_BEGIN

// A mask's limit is the lowest alpha, of 255, that stops a ray; or, with this bit, the factor of a
// blended surface's alpha, of 65535.
SHARED_CONSTANT uint mask_blended = 0x10000000u;
SHARED_CONSTANT uint mask_factor = 0xffffu;

// std430; for tracers whose hierarchies are the driver's.
struct RayMask {
  uint texels;  // offset in bytes into the alpha heap
  uint width;   // 0: no texture, alpha is 255 all over
  uint height;
  uint limit;
  uint wrap_s;  // values of wrap_*
  uint wrap_t;
  uint first_uv;  // three per triangle
  uint padding0;
};

// Every bit of the result depends on every bit of v (the end of MurmurHash3, Appleby 2011).
SHARED_FUNCTION uint mixed_bits(uint v) {
  v ^= v >> 16u;
  v *= 0x85ebca6bu;
  v ^= v >> 13u;
  v *= 0xc2b2ae35u;
  return v ^ (v >> 16u);
}

// Whether a surface stops a ray. `blending`: a number of the ray and its frame; 0: blended surfaces
// stop it.
SHARED_FUNCTION bool alpha_stops(uint alpha, uint limit, uint blending, uint instance,
                                 uint triangle) {
  if ((limit & mask_blended) == 0u) return alpha >= limit;
  if (blending == 0u) return true;
  uint random = mixed_bits(blending ^ mixed_bits(instance * 0x9e3779b9u + triangle));
  return random % (255u * mask_factor) < alpha * (limit & mask_factor);
}

SHARED_END
#endif
