#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/geometry/primitives.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

struct BuiltMesh {
  Mesh mesh;
  std::vector<std::uint32_t> sources;  // per vertex: index of its source vertex in the file
};

/// Reads one primitive's triangles. Missing normals become face normals (glTF 3.7.2.1); missing
/// tangents are generated for `material`'s normal map, without one for its anisotropy, and
/// arbitrary without either. `material` is an index into `materials` and their `layers`.
/// @throws ImportError when an index is out of range or a number is not finite, LoadCancelled
BuiltMesh build_mesh(const Primitive& primitive, std::span<const Accessor> accessors,
                     std::uint32_t material, std::span<const shared::Material> materials,
                     std::span<const MaterialLayers> layers, const std::stop_token& stop);

}  // namespace heliograph::scene
