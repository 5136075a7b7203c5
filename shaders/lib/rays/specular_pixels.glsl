// Which pixels trace specular rays: all, or one of each 2x2.
#ifndef HELIOGRAPH_SPECULAR_PIXELS_GLSL
#define HELIOGRAPH_SPECULAR_PIXELS_GLSL
#include "lib/frame.glsl"
#include "lib/math/random.glsl"

/// Roughness is stored in steps of 1 / 255: a little more than half of one is still the same.
bool mirrors_rays(float roughness, float max_roughness) {
  return roughness <= max_roughness + 0.6 / 255.0;
}

/// Whose turn it is of the pixels in a 2x2 cell: all come in four frames, the second opposite the
/// first.
uint pixel_turn() { return frame.sample_index & 3u; }

/// The pixel that traces for a cell of `scale` x `scale`.
ivec2 traced_pixel(ivec2 cell, int scale) {
  if (scale == 1) return cell;
  uint turn = pixel_turn();
  ivec2 within = ivec2((turn ^ (turn >> 1u)) & 1u, turn & 1u);
  return min(cell * 2 + within, ivec2(frame.extent) - 1);
}

/// Where the traced pixel stands in a sequence of random numbers: sample (x) and dimension (y).
/// Pixels that take turns each walk a sequence of their own: of a common one they would see every
/// fourth sample, a quarter of the lobe.
uvec2 sequence_place(uint dimension, int scale) {
  if (scale == 1) return uvec2(frame.sample_index, dimension);
  return uvec2(frame.sample_index >> 2u, 16u + 4u * dimension + pixel_turn());
}

vec2 specular_pair(ivec2 cell, uint dimension, int scale) {
  uvec2 place = sequence_place(dimension, scale);
  return random_pair(uvec2(cell), place.x, place.y, frame.seed);
}

float specular_number(ivec2 cell, uint dimension, int scale) {
  uvec2 place = sequence_place(dimension, scale);
  return random_number(uvec2(cell), place.x, place.y, frame.seed);
}

#endif
