#pragma once

#include <optional>

#include "scene/environment.hpp"

namespace heliograph::scene {

/// A sun as a directional light has it, in the environment's own frame.
struct Sun {
  glm::vec3 direction;     // toward it, unit length
  glm::vec3 irradiance;    // of a surface that faces it
  float angular_diameter;  // degrees
};

struct SeparatedEnvironment {
  Environment sky;  // where the sun was, as bright as around it
  std::optional<Sun> sun;
};

/// Takes a small, very bright region (below 0.01 sr, some dozen times the mean radiance) out of an
/// environment: as texels it makes fireflies in every filter and one noisy sample in thousands, as
/// a light its shadows are traced. Sky and sun together shine like the whole.
SeparatedEnvironment separate_sun(Environment environment);

}  // namespace heliograph::scene
