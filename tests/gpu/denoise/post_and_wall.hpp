#pragma once

#include <array>

#include "tests/support/frame_rig.hpp"

namespace heliograph::test {

/// Of the frames that show it.
inline constexpr VkExtent2D wall_extent{48, 32};

/// A post in front of a wall, scaled by `scale`; `joined`: as one instance, whose parts differ in
/// depth only.
struct PostAndWall {
  explicit PostAndWall(float scale_, bool joined = false) : scale(scale_) {
    const auto corners = [&](float x0, float x1, float y, float z) {
      return std::array{scale * glm::vec3(x0, -y, z), scale * glm::vec3(x1, -y, z),
                        scale * glm::vec3(x1, y, z), scale * glm::vec3(x0, y, z)};
    };
    const std::array quads{corners(-20, 20, 15, -4), corners(-0.4f, 0.4f, 5, 0)};
    if (joined) {
      builder.place(builder.add_quads(quads, surface({0.5f, 0.5f, 0.5f})));
      return;
    }
    for (const auto& quad : quads) {
      builder.place(builder.add_quad(quad, surface({0.5f, 0.5f, 0.5f})));
    }
  }
  scene::Camera from(float x) const {
    scene::Camera camera = look(scale * glm::vec3(x, 0.1f, 4), scale * glm::vec3(x, 0.1f, 0));
    camera.near_plane *= scale;
    return camera;
  }

  float scale;
  SceneBuilder builder;
};

}  // namespace heliograph::test
