#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/environment.hpp"

namespace heliograph::render {

/// The light of an environment that reaches a surface which faces up.
struct UpperLight {
  /// Drawn in proportion to luminance x cosine, in the order of the map's texels.
  std::vector<glm::vec3> directions;
  float irradiance = 0.0f;  // luminance
};

inline double brightness_of(const glm::vec3& light) {
  return glm::dot(glm::dvec3(light), glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// `count` directions; none where it is dark above.
UpperLight upper_light(const scene::Environment& map, std::size_t count);

}  // namespace heliograph::render
