#pragma once

#include <optional>

#include "scene/environment.hpp"

namespace heliograph::scene {

/// A sun as a directional light, in the environment's frame.
struct Sun {
  glm::vec3 direction;     // toward it, unit length
  glm::vec3 irradiance;    // of a surface that faces it
  float angular_diameter;  // degrees
};

struct SeparatedEnvironment {
  Environment sky;  // the sun replaced by the radiance around it
  std::optional<Sun> sun;
};

/// Separates a small, very bright region (below 0.01 sr, at least 24 times the mean radiance) from
/// an environment: as texels it causes fireflies, as a directional light it gets traced shadows.
/// Sky and sun together have the flux of the input.
SeparatedEnvironment separate_sun(Environment environment);

}  // namespace heliograph::scene
