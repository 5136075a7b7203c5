#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace heliograph::render {

/// Planes that cut a scene open: what is in front of any of them is gone, with its shadows and
/// reflections. Where a plane cuts a solid, a cap in a flat colour closes it; surfaces with two
/// sides and blended ones enclose no solid.
struct Section {
  /// Unit normal and offset, metres: points with dot(normal, point) > offset are cut away. At most
  /// shared::most_section_planes.
  std::vector<glm::vec4> planes;
  glm::vec3 cap_color{0.5f, 0.12f, 0.08f};  // linear

  bool operator==(const Section&) const = default;
};

}  // namespace heliograph::render
