#include "render/passes/gbuffer/frustum.hpp"

namespace heliograph::render {

// Gribb and Hartmann 2001: rows of the matrix combine into the clip inequalities.
Frustum::Frustum(const glm::mat4& m) {
  const auto row = [&](int i) { return glm::vec4(m[0][i], m[1][i], m[2][i], m[3][i]); };
  planes_ = {row(3) + row(0), row(3) - row(0), row(3) + row(1), row(3) - row(1), row(3) - row(2)};
}

bool Frustum::may_contain(const scene::Bounds& box) const {
  for (const glm::vec4& plane : planes_) {
    const glm::vec3 farthest{plane.x > 0.0f ? box.maximum.x : box.minimum.x,
                             plane.y > 0.0f ? box.maximum.y : box.minimum.y,
                             plane.z > 0.0f ? box.maximum.z : box.minimum.z};
    if (glm::dot(glm::vec3(plane), farthest) + plane.w < 0.0f) return false;
  }
  return true;
}

}  // namespace heliograph::render
