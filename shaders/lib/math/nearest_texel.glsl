// Where glTF's wrapping finds a texel: the same in server/tracing/bvh/alpha_mask.cpp.
#ifndef HELIOGRAPH_LIB_NEAREST_TEXEL_GLSL
#define HELIOGRAPH_LIB_NEAREST_TEXEL_GLSL

#include "shared/scene.h"

// Into 0..1.
float wrap(float coordinate, uint mode) {
  if (mode == wrap_clamp) return clamp(coordinate, 0.0, 1.0);
  if (mode == wrap_mirror) {
    return 1.0 - abs(coordinate - 2.0 * floor(0.5 * coordinate) - 1.0);
  }
  return coordinate - floor(coordinate);
}

// Index of the texel nearest to uv, row by row. `modes`: values of wrap_* for u and v.
uint nearest_texel(vec2 uv, uvec2 size, uvec2 modes) {
  const vec2 wrapped = vec2(wrap(uv.x, modes.x), wrap(uv.y, modes.y));
  const uvec2 texel = min(uvec2(wrapped * vec2(size)), size - 1u);
  return texel.y * size.x + texel.x;
}

#endif
