#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/geometry/primitives.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// What `mesh`, built from `primitive`, deforms from. `sources` are the primitive's vertices that
/// the mesh's were made of.
/// @throws ImportError when a number is not finite or a weight negative
Shape build_shape(const Primitive& primitive, std::span<const Accessor> accessors, const Mesh& mesh,
                  std::span<const std::uint32_t> sources);

/// Whether every joint that the shape names exists. @throws ImportError when not
void check_joints(const Shape& shape, const Skin& skin, const std::string& path);

}  // namespace heliograph::scene
