// The guide in half of its space, for filters that are bound by what their taps read.
#ifndef HELIOGRAPH_DENOISE_PACKED_GUIDE_GLSL
#define HELIOGRAPH_DENOISE_PACKED_GUIDE_GLSL
#include "lib/denoise/guide.glsl"
#include "lib/denoise/history_texels.glsl"
#include "lib/math/octahedral.glsl"

const float packed_normal_steps = 2047.0;  // to either side of 0

/// x: the bits of view Z, 0 for the background. y: the normal, octahedral, 12 bits an axis (within
/// 0.06 degrees; axes are exact), and roughness in 8 bits, as the G-buffer has it.
uvec2 pack_guide(Guide guide) {
  ivec2 normal = ivec2(round(octahedral_encode(guide.normal) * packed_normal_steps)) & 0xfff;
  uint roughness = uint(round(clamp(guide.roughness, 0.0, 1.0) * 255.0));
  return uvec2(floatBitsToUint(guide.view_z),
               uint(normal.x) | uint(normal.y) << 12u | roughness << 24u);
}

const uvec2 packed_background = uvec2(0u);
bool is_background(uvec2 packed_guide) { return packed_guide.x == packed_background.x; }

/// The octahedral normal, in steps. As bits of a float from 2^23 to 2^24, whose own steps are 1, a
/// number takes no conversion.
vec2 packed_axes(uvec2 packed_guide) {
  const uint exponent = 0x4b000000u, sign_bit = 0x800u;
  uvec2 axes = uvec2(packed_guide.y, packed_guide.y >> 12u) & 0xfffu;
  return uintBitsToFloat(axes ^ (exponent | sign_bit)) - (8388608.0 + float(sign_bit));
}

/// The normal, of any length: filters need no more than its direction.
vec3 packed_direction(uvec2 packed_guide) {
  return octahedral_direction(packed_axes(packed_guide), packed_normal_steps);
}

float packed_roughness(uvec2 packed_guide) { return float(packed_guide.y >> 24u) * (1.0 / 255.0); }
float packed_view_z(uvec2 packed_guide) { return uintBitsToFloat(packed_guide.x); }

/// Of the background, too, whose normal means nothing.
Guide unpack_guide(uvec2 packed_guide) {
  return Guide(octahedral_decode(packed_axes(packed_guide) / packed_normal_steps),
               packed_roughness(packed_guide), packed_view_z(packed_guide));
}

/// Change of view Z from texel to texel in parts of view Z, for rg16f images: in scenes of any size
/// halves hold it.
vec4 pack_slope(vec2 slope, float view_z) {
  return nearest_halves(vec4(slope / view_z, 0.0, 0.0));
}

vec2 unpack_slope(vec4 packed_slope, float view_z) { return packed_slope.xy * view_z; }

#endif
