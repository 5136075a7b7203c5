#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace heliograph::render {

/// A unit vector from two numbers in [-1, 1]: shaders/lib/math/octahedral.glsl.
inline glm::vec3 octahedral_decode(const glm::vec2& p) {
  glm::vec3 d{p, 1.0f - std::abs(p.x) - std::abs(p.y)};
  const float below = std::max(-d.z, 0.0f);
  d.x += d.x >= 0.0f ? -below : below;
  d.y += d.y >= 0.0f ? -below : below;
  return glm::normalize(d);
}

/// The inverse.
inline glm::vec2 octahedral_encode(const glm::vec3& direction) {
  const glm::vec3 size = glm::abs(direction);
  const glm::vec2 p = glm::vec2(direction) / (size.x + size.y + size.z);
  if (direction.z >= 0.0f) return p;
  return {(1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
          (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f)};
}

}  // namespace heliograph::render
