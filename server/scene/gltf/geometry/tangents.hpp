#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <stop_token>
#include <vector>

#include "shaders/shared/scene.h"

namespace heliograph::scene {

/// Generates the tangents of a triangle mesh by MikkTSpace's convention (M. Mikkelsen, "Simulation
/// of Wrinkled Surfaces Revisited", 2008), which glTF 3.7.2.1 prescribes where a file has none:
/// each triangle's tangent is projected onto the plane of the corner's normal and weighted by the
/// corner's angle; corners that agree in position, normal, texture coordinates and handedness share
/// the sum. Vertices used with both hands are split, so `vertices` may grow and `indices` change.
/// The bitangent is cross(normal, tangent) * tangent.w and points where texture v decreases (up).
/// Normals must be of unit length. `normal_map` says which uv set and transform the texture uses.
/// @throws LoadCancelled
void generate_tangents(std::vector<shared::Vertex>& vertices, std::vector<std::uint32_t>& indices,
                       const shared::TextureSlot& normal_map, const std::stop_token& stop = {});

/// Any unit vector perpendicular to the unit vector `normal`.
glm::vec3 perpendicular_to(const glm::vec3& normal);

}  // namespace heliograph::scene
