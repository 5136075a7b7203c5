#pragma once

#include <span>

#include "scene/animation/pose.hpp"

namespace heliograph::scene {

/// Whether a mesh that deforms has another shape in one pose than in another.
bool shape_differs(const Scene& scene, const Deformation& deformation, const Pose& a,
                   const Pose& b);

/// The vertices of a mesh that deforms, in `pose`: morph targets move them first (glTF 3.7.2.2),
/// then joints (3.7.3.3), on all processors. Normals follow the inverse transpose of the blended
/// joint matrices, or belong to the moved triangles where the file has none. `vertices` is as long
/// as the shape's.
/// @return a box around them, mesh space
Bounds deform(const Scene& scene, const Deformation& deformation, const Pose& pose,
              std::span<shared::Vertex> vertices);

}  // namespace heliograph::scene
