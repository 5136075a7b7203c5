#pragma once

#include <array>
#include <cstdint>

namespace heliograph::scene::bc7 {

// Khronos Data Format, "BPTC": block modes and partitions.

inline constexpr int texels_of_block = 16;  // 4 x 4, a row after the other

/// How a mode stores the ends of a line between which colours are interpolated.
struct LineFormat {
  /// The lowest bit of all channels of an end: each its own, or the same for both ends.
  enum class LowBit { none, shared, own };
  int channels;
  int bits;  // of a channel, with the low bit
  LowBit low_bit;
  int index_bits;  // of a texel
};

inline constexpr LineFormat mode_1{3, 7, LineFormat::LowBit::shared, 3};       // of two subsets
inline constexpr LineFormat mode_3{3, 8, LineFormat::LowBit::own, 2};          // of two subsets
inline constexpr LineFormat mode_5{3, 7, LineFormat::LowBit::none, 2};         // three channels
inline constexpr LineFormat mode_5_scalar{1, 8, LineFormat::LowBit::none, 2};  // the fourth
inline constexpr LineFormat mode_6{4, 8, LineFormat::LowBit::own, 4};
inline constexpr LineFormat mode_7{4, 6, LineFormat::LowBit::own, 2};  // of two subsets

/// Weight of the second end, of 64: the tables of the specification are these quotients, rounded.
constexpr int weight_of(int index, int index_bits) {
  const int last = (1 << index_bits) - 1;
  return (128 * index + last) / (2 * last);
}

/// A channel's 8 bits from the `bits` that are stored.
constexpr int expanded(int code, int bits) {
  const int high = code << (8 - bits);
  return high | high >> bits;
}

/// Partitions into two subsets: the texels of the second, from bit 0 on.
inline constexpr std::array<std::uint16_t, 64> second_subsets = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80,
    0xe800, 0xffe8, 0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310,
    0x3100, 0x8cce, 0x088c, 0x3110, 0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c, 0xaaaa,
    0xf0f0, 0x5a5a, 0x33cc, 0x3c3c, 0x55aa, 0x9696, 0xa55a, 0x73ce, 0x13c8, 0x324c, 0x3bdc,
    0x6996, 0xc33c, 0x9966, 0x0660, 0x0272, 0x04e4, 0x4e40, 0x2720, 0xc936, 0x936c, 0x39c6,
    0x639c, 0x9336, 0x9cc6, 0x817e, 0xe718, 0xccf0, 0x0fcc, 0x7744, 0xee22,
};

/// The texel of the second subset whose highest index bit is not stored. The first subset's is 0.
inline constexpr std::array<std::uint8_t, 64> second_anchors = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2,  2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8,  2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15,
};

}  // namespace heliograph::scene::bc7
