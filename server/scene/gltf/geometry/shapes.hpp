#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/geometry/primitives.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The deformation source of `mesh`, which was built from `primitive`. `sources`: the primitive's
/// vertex of every mesh vertex.
/// @throws ImportError when a number is not finite or a weight negative
Shape build_shape(const Primitive& primitive, std::span<const Accessor> accessors, const Mesh& mesh,
                  std::span<const std::uint32_t> sources);

/// Checks that every joint index of the shape exists. @throws ImportError when not
void check_joints(const Shape& shape, const Skin& skin, const std::string& path);

}  // namespace heliograph::scene
