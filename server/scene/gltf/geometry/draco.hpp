#pragma once

#include <span>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/geometry/primitives.hpp"

namespace heliograph::scene {

/// Counts that a Draco stream's header claims.
struct DracoCounts {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;  // at most
};

/// @throws ImportError when the header is damaged, or is not of a mesh of bitstream 2.2
DracoCounts probe_draco(const DracoGeometry& geometry);

/// A primitive with its own self-contained accessors.
struct UnpackedPrimitive {
  Primitive primitive;
  std::vector<Accessor> accessors;
  std::vector<std::vector<std::uint8_t>> storage;  // data of the accessors
};

/// Decodes `primitive.draco`. Attributes get the types of their accessors; attributes that are not
/// in the stream keep the document's data.
/// @throws ImportError when the stream is damaged or does not fit the primitive
UnpackedPrimitive unpack_draco(const Primitive& primitive, std::span<const Accessor> accessors);

}  // namespace heliograph::scene
