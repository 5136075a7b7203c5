#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace heliograph::stream {

/// Elements of arrays as NumPy names them.
enum class NpyElement { uint8, uint32, float32 };

/// An array as a .npy file of version 1.0 (NumPy's NEP 1): `values` are its elements in C order,
/// little-endian, whatever `shape` says.
/// @throws std::invalid_argument where they are not as many as `shape` says
std::vector<std::uint8_t> encode_npy(NpyElement element, std::span<const std::uint32_t> shape,
                                     std::span<const std::byte> values);

}  // namespace heliograph::stream
