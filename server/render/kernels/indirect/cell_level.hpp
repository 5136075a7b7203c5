#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "render/kernels/common/random.hpp"

/// How places of the world are hashed: shaders/lib/lighting/cell_level.glsl.
namespace heliograph::render::kernels {

/// The least integer whose power of two is `size` or more.
inline int level_of(float size) {
  int exponent = 0;
  // A fraction of at least a half, times a power of two.
  const float fraction = std::frexp(size, &exponent);
  return fraction == 0.5f ? exponent - 1 : exponent;
}

/// Sizes of the radiance cache's cells as far as the eye is concerned.
struct CellScale {
  glm::vec3 eye;     // world
  float cell_angle;  // size of cells as a fraction of their distance
  float least_size;  // metres

  int level_at(const glm::vec3& position) const {
    return level_of(std::max(glm::distance(position, eye) * cell_angle, least_size));
  }
};

/// 0 to 5: the axis that a normal follows most.
inline std::uint32_t normal_axis(const glm::vec3& n) {
  const glm::vec3 a = glm::abs(n);
  if (a.x >= a.y && a.x >= a.z) return n.x >= 0.0f ? 0 : 1;
  if (a.y >= a.z) return n.y >= 0.0f ? 2 : 3;
  return n.z >= 0.0f ? 4 : 5;
}

}  // namespace heliograph::render::kernels
