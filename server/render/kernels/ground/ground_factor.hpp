#pragma once

#include <algorithm>
#include <glm/glm.hpp>

#include "shaders/shared/ground.h"

namespace heliograph::render::kernels {

/// The factor of the background behind the plane that catches shadows, for a line of sight in world
/// space: shaders/lib/lighting/ground.glsl. `shade`: the part of its light that arrives, of every
/// texel. `ground`: FrameConstants::ground.
inline float ground_factor(const glm::vec4& ground, const float* shade, const glm::vec3& origin,
                           const glm::vec3& direction) {
  if (ground.w <= 0.0f || direction.y >= 0.0f || origin.y <= ground.y) return 1.0f;
  const float t = (ground.y - origin.y) / direction.y;
  const glm::vec3 met = origin + t * direction;
  const glm::vec2 at = glm::vec2(met.x - ground.x, met.z - ground.z) / ground.w;
  const float from_middle = glm::length(at);
  if (!(from_middle < 1.0f)) return 1.0f;
  constexpr int side = static_cast<int>(shared::ground_side);
  const auto texel_at = [shade](int x, int y) {
    return shade[std::clamp(y, 0, side - 1) * side + std::clamp(x, 0, side - 1)];
  };
  const glm::vec2 texel = (0.5f * at + 0.5f) * static_cast<float>(side) - 0.5f;
  const glm::vec2 first = glm::floor(texel), between = texel - first;
  const int x = static_cast<int>(first.x), y = static_cast<int>(first.y);
  const float above = glm::mix(texel_at(x, y), texel_at(x + 1, y), between.x);
  const float below = glm::mix(texel_at(x, y + 1), texel_at(x + 1, y + 1), between.x);
  const float faded = glm::smoothstep(shared::ground_fade_start, 1.0f, from_middle);
  return glm::mix(glm::mix(above, below, between.y), 1.0f, faded);
}

}  // namespace heliograph::render::kernels
