#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/geometry/primitives.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

struct BuiltMesh {
  Mesh mesh;
  std::vector<std::uint32_t> sources;  // by vertex: the vertex of the file that it was made of
};

/// Reads one primitive's triangles. Missing normals become flat ones (glTF 3.7.2.1); missing
/// tangents are made for `material`'s normal map, or arbitrary where there is none. `material` is
/// the index stored in the mesh, `materials` what it indexes.
/// @throws ImportError when an index is out of range or a number is not finite
BuiltMesh build_mesh(const Primitive& primitive, std::span<const Accessor> accessors,
                     std::uint32_t material, std::span<const shared::Material> materials);

}  // namespace heliograph::scene
