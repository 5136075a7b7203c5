// Which pixels trace specular rays: all, or one of each 2x2.
#ifndef HELIOGRAPH_SPECULAR_PIXELS_GLSL
#define HELIOGRAPH_SPECULAR_PIXELS_GLSL
#include "lib/frame.glsl"
#include "lib/math/random.glsl"

const float distance_of_misses = 1e4;  // metres
const float farthest_hit = 0.999 * distance_of_misses;  // what is hit beyond counts as there

/// Roughness is stored in steps of 1 / 255: a little more than half of one is still the same.
bool traces_specular(float roughness, float max_roughness) {
  return roughness <= max_roughness + 0.6 / 255.0;
}

/// Which pixel of a 2x2 cell traces in this frame: all do in four frames, the second opposite the
/// first.
uint pixel_phase() { return frame.sample_index & 3u; }

/// The pixel that traces for a cell of `scale` x `scale`.
ivec2 traced_pixel(ivec2 cell, int scale) {
  if (scale == 1) return cell;
  uint phase = pixel_phase();
  ivec2 within = ivec2((phase ^ (phase >> 1u)) & 1u, phase & 1u);
  return min(cell * 2 + within, ivec2(frame.extent) - 1);
}

/// Where the traced pixel stands in a sequence of random numbers: sample (x) and dimension (y).
/// Each pixel of the cell has a sequence of its own: of a common one they would see every
/// fourth sample, a quarter of the lobe.
uvec2 sequence_position(uint dimension, int scale) {
  if (scale == 1) return uvec2(frame.sample_index, dimension);
  return uvec2(frame.sample_index >> 2u, 16u + 4u * dimension + pixel_phase());
}

vec2 specular_pair(ivec2 cell, uint dimension, int scale) {
  uvec2 position = sequence_position(dimension, scale);
  return random_pair(uvec2(cell), position.x, position.y, frame.seed);
}

float specular_number(ivec2 cell, uint dimension, int scale) {
  uvec2 position = sequence_position(dimension, scale);
  return random_number(uvec2(cell), position.x, position.y, frame.seed);
}

#endif
