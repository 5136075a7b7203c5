#pragma once

#include <span>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/geometry/primitives.hpp"

namespace heliograph::scene {

/// How much a Draco stream claims to hold, from its header alone.
struct DracoCounts {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;  // at most
};

/// @throws ImportError when the header is damaged, or is not of a mesh of bitstream 2.2
DracoCounts probe_draco(const DracoGeometry& geometry);

/// A primitive with accessors of its own, which need no others.
struct UnpackedPrimitive {
  Primitive primitive;
  std::vector<Accessor> accessors;
  std::vector<std::vector<std::uint8_t>> storage;  // what the accessors point into
};

/// Unpacks `primitive.draco`. Attributes come in the types that their accessors have; what is not
/// in the stream stays as the document has it.
/// @throws ImportError when the stream is damaged or does not fit the primitive
UnpackedPrimitive unpack_draco(const Primitive& primitive, std::span<const Accessor> accessors);

}  // namespace heliograph::scene
