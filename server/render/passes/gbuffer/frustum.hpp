#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace heliograph::render {

/// The planes of a reversed-Z projection: left, right, top, bottom, near (there is no far plane).
class Frustum {
 public:
  explicit Frustum(const glm::mat4& view_projection);
  /// False only when the box lies wholly outside one plane.
  bool may_contain(const scene::Bounds& world) const;

 private:
  std::array<glm::vec4, 5> planes_;
};

}  // namespace heliograph::render
