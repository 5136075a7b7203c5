#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {

/// Decodes a buffer view of EXT_meshopt_compression: all modes and filters. `packed` is the
/// extension's object, `source` its bytes, `length` the view's byteLength and the size of the
/// result. `budget` is the number of bytes that this file may still decode, and is reduced.
/// @throws ImportError
std::vector<std::uint8_t> unpack_meshopt(const ExtensionValue& packed,
                                         std::span<const std::uint8_t> source, std::uint64_t length,
                                         std::uint64_t& budget);

}  // namespace heliograph::scene
