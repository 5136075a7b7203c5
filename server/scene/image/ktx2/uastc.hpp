#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace heliograph::scene::ktx2 {

inline constexpr std::size_t uastc_block_bytes = 16;

/// Decodes a block of 4 x 4 texels, a row after the other, into RGBA8. Invalid blocks are magenta,
/// as the specification says (Khronos Data Format, "Universal ASTC").
std::array<std::uint8_t, 64> decode_uastc(std::span<const std::uint8_t, uastc_block_bytes> block,
                                          bool srgb);

}  // namespace heliograph::scene::ktx2
