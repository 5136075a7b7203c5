#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/gltf/document/json_value.hpp"

namespace heliograph::scene {

/// Unpacks a buffer view of EXT_meshopt_compression: all three modes, all filters.
/// `packed` is the extension's object on the view, `source` the bytes that it names, `length` the
/// view's own byteLength, which the result has. `budget` is what may still be unpacked in this
/// file, and shrinks.
/// @throws ImportError
std::vector<std::uint8_t> unpack_meshopt(const JsonValue& packed,
                                         std::span<const std::uint8_t> source, std::uint64_t length,
                                         std::uint64_t& budget);

}  // namespace heliograph::scene
