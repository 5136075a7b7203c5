#pragma once

#include <array>
#include <cstdint>

namespace heliograph::scene::bc7 {

inline constexpr int block_bytes = 16;
using Block = std::array<std::uint8_t, block_bytes>;

struct EncodedBlock {
  Block bytes;
  float error;  // sum of squared differences of all texels and channels, as decoders see them
};

/// Encodes 4 x 4 texels of RGBA8, a row after the other, in that of the modes 1, 3, 5, 6 and 7 that
/// fits best of those that the block's content suggests. Blocks of one colour come back exactly, as
/// does an alpha of 255.
EncodedBlock encode_block(const std::array<std::uint8_t, 64>& texels);

}  // namespace heliograph::scene::bc7
