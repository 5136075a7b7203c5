// Histories hold 16 bits a channel. Rounded to the nearest step a running mean would come to rest
// as soon as a new sample's part of it is less than half of a step: they are rounded to the step
// below or above, in turn, each the more often the nearer it is.
#ifndef HELIOGRAPH_HISTORY_TEXELS_GLSL
#define HELIOGRAPH_HISTORY_TEXELS_GLSL
#include "shared/denoise.h"

/// A number per channel, uniform in 32 bits over the frames of a pixel and over pixels.
uvec4 rounding_of(ivec2 pixel, uint frame_number) {
  uint hash = uint(pixel.x) * 0x8da6b343u + uint(pixel.y) * 0xd8163841u;
  hash = (hash ^ (hash >> 16u)) * 0x7feb352du;
  return hash + frame_number * rounding_step + (uvec4(0u, 1u, 2u, 3u) << 30u);
}

/// For rgba16f images, which take the result without rounding.
vec4 as_halves(vec4 value, uvec4 rounding) {
  vec4 finite = clamp(value, -largest_half, largest_half);
  return uintBitsToFloat((floatBitsToUint(finite) + (rounding >> 19u)) & 0xffffe000u);
}

/// Likewise, but to the nearest step: for what is no running mean. Stores of other values round
/// toward zero on some devices, which would darken them.
vec4 nearest_halves(vec4 value) { return as_halves(value, uvec4(0x80000000u)); }

/// Of 0 to 1 for rgba16 images, in turn; what lies next to nothing away from a step is on it.
vec4 as_fractions(vec4 value, uvec4 rounding) {
  vec4 offset =
      vec4(rounding >> 16u) * (rounding_range / 65536.0) + (0.5 - 0.5 * rounding_range);
  return floor(clamp(value, 0.0, 1.0) * 65535.0 + offset) / 65535.0;
}

#endif
