#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace heliograph::stream {

/// Element types of arrays, named as in NumPy.
enum class NpyElement { uint8, uint32, float32 };

/// An array as a .npy file of version 1.0 (NumPy's NEP 1): `values` are its elements in C order,
/// little-endian.
/// @throws std::invalid_argument if `values` does not match `shape`
std::vector<std::uint8_t> encode_npy(NpyElement element, std::span<const std::uint32_t> shape,
                                     std::span<const std::byte> values);

}  // namespace heliograph::stream
