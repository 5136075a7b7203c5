#ifndef HELIOGRAPH_CELL_LEVEL_GLSL
#define HELIOGRAPH_CELL_LEVEL_GLSL
#include "lib/frame.glsl"

/// Binary logarithm of the edge length of the radiance cache's cells at `position`, as far as the eye
/// is concerned. `least_size`: metres.
int cell_level(vec3 position, float cell_angle, float least_size) {
  float size = distance(position, frame.eye.xyz) * cell_angle;
  return int(ceil(log2(max(size, least_size))));
}

/// 0 to 5: the axis that a normal follows most.
uint normal_axis(vec3 n) {
  vec3 a = abs(n);
  if (a.x >= a.y && a.x >= a.z) return n.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return n.y >= 0.0 ? 2u : 3u;
  return n.z >= 0.0 ? 4u : 5u;
}

#endif
