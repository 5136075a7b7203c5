#pragma once

#include <glm/glm.hpp>

namespace heliograph::render::kernels {

/// Three random numbers that follow from three: shaders/lib/math/random.glsl.
inline glm::uvec3 pcg3d(glm::uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

}  // namespace heliograph::render::kernels
