#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "scene/animation/pose.hpp"

namespace heliograph::scene {

/// A point of a triangle, which stays there however its mesh moves or deforms.
struct SurfaceAnchor {
  std::uint32_t instance = 0;    // of the scene
  std::uint32_t triangle = 0;    // of the instance's mesh
  glm::vec3 barycentrics{0.0f};  // weights of its vertices; their sum is 1
  bool operator==(const SurfaceAnchor&) const = default;
};

/// World space.
struct SurfaceLocation {
  glm::vec3 position;
  glm::vec3 normal;  // of the triangle, unit length; zero where it has no area
};

/// Whether the scene has that triangle.
bool has_triangle(const Scene& scene, const SurfaceAnchor& anchor);
/// Where an anchor is in `pose`. @pre has_triangle
SurfaceLocation locate(const Scene& scene, const Pose& pose, const SurfaceAnchor& anchor);
/// The vertices of an instance in `pose`, world space.
std::vector<glm::vec3> world_positions(const Scene& scene, const Pose& pose,
                                       std::uint32_t instance);

}  // namespace heliograph::scene
