#pragma once

#include <span>

#include "scene/animation/pose.hpp"

namespace heliograph::scene {

/// Whether a deforming mesh has different vertices in two poses.
bool shape_differs(const Scene& scene, const Deformation& deformation, const Pose& a,
                   const Pose& b);

/// The vertices of a deforming mesh in `pose`: morph targets (glTF 3.7.2.2), then joints (3.7.3.3),
/// on all cores. Normals use the inverse transpose of the blended joint matrices, or are those of
/// the deformed triangles where the file has none. `vertices` has as many elements as the shape.
/// @return their bounding box in mesh space
Bounds deform(const Scene& scene, const Deformation& deformation, const Pose& pose,
              std::span<shared::Vertex> vertices);

/// Where `deform` places one vertex, mesh space.
glm::vec3 deformed_position(const Scene& scene, const Deformation& deformation, const Pose& pose,
                            std::uint32_t vertex);

}  // namespace heliograph::scene
