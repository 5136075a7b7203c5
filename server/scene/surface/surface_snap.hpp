#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "protocol/messages/surface_kinds.hpp"

namespace heliograph::scene {

/// What is looked for near a ray's hit. World space, metres.
struct SnapQuery {
  glm::vec3 origin;
  glm::vec3 direction;    // unit length
  float distance = 0.0f;  // roughly where the ray meets the surface
  float radius = 0.0f;    // how far from there vertices and edges may be
  bool vertices = true;
  bool edges = true;
};

using protocol::SurfaceFeature;

struct SnappedPoint {
  std::uint32_t triangle = 0;
  glm::vec3 barycentrics{0.0f};
  glm::vec3 position{0.0f};
  SurfaceFeature feature = SurfaceFeature::face;
};

/// The nearest vertex within the radius around the point where a ray meets a mesh; without one the
/// nearest point of an edge, else that point itself. Edges inside a flat face, which only divide it
/// into triangles, are none. Of several hits the one nearest to `distance` counts; where the ray
/// just misses, the nearest point of the mesh. Empty: there are no triangles.
std::optional<SnappedPoint> snap_to_mesh(std::span<const glm::vec3> positions,
                                         std::span<const std::uint32_t> indices,
                                         const SnapQuery& query);

}  // namespace heliograph::scene
