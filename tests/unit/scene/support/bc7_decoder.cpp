#include "tests/unit/scene/support/bc7_decoder.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace heliograph::scene::test {
namespace {

constexpr const char* partitions[64] = {
    "0011001100110011", "0001000100010001", "0111011101110111", "0001001100110111",
    "0000000100010011", "0011011101111111", "0001001101111111", "0000000100110111",
    "0000000000010011", "0011011111111111", "0000000101111111", "0000000000010111",
    "0001011111111111", "0000000011111111", "0000111111111111", "0000000000001111",
    "0000100011101111", "0111000100000000", "0000000010001110", "0111001100010000",
    "0011000100000000", "0000100011001110", "0000000010001100", "0111001100110001",
    "0011000100010000", "0000100010001100", "0110011001100110", "0011011001101100",
    "0001011111101000", "0000111111110000", "0111000110001110", "0011100110011100",
    "0101010101010101", "0000111100001111", "0101101001011010", "0011001111001100",
    "0011110000111100", "0101010110101010", "0110100101101001", "0101101010100101",
    "0111001111001110", "0001001111001000", "0011001001001100", "0011101111011100",
    "0110100110010110", "0011110011000011", "0110011010011001", "0000011001100000",
    "0100111001000000", "0010011100100000", "0000001001110010", "0000010011100100",
    "0110110010010011", "0011011011001001", "0110001110011100", "0011100111000110",
    "0110110011001001", "0110001100111001", "0111111010000001", "0001100011100111",
    "0000111100110011", "0011001111110000", "0010001011101110", "0100010001110111",
};

constexpr int anchors_of_second[64] = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2,  2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8,  2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15,
};

class BlockBits {
 public:
  explicit BlockBits(std::span<const std::uint8_t, 16> block) {
    for (const std::uint8_t byte : block) {
      for (int i = 0; i < 8; ++i) bits_.push_back(byte >> i & 1);
    }
  }
  int take(int count) {
    int value = 0;
    for (int i = 0; i < count; ++i) value += bits_.at(next_++) << i;
    return value;
  }

 private:
  std::vector<int> bits_;
  std::size_t next_ = 0;
};

int weight(int index, int bits) {
  static const std::vector<std::vector<int>> weights = {
      {0, 21, 43, 64},
      {0, 9, 18, 27, 37, 46, 55, 64},
      {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64}};
  return weights.at(static_cast<std::size_t>(bits - 2)).at(static_cast<std::size_t>(index));
}

std::uint8_t between(int first, int second, int weight) {
  return static_cast<std::uint8_t>(((64 - weight) * first + weight * second + 32) / 64);
}

/// The highest bits are repeated below the lowest.
int to_8_bits(int value, int bits) {
  const int shifted = value * (1 << (8 - bits));
  return shifted + shifted / (1 << bits);
}

struct Ends {
  std::array<int, 4> first{255, 255, 255, 255};
  std::array<int, 4> second{255, 255, 255, 255};
};

void decode_mode_5(BlockBits& bits, DecodedBlock& block) {
  const int rotation = bits.take(2);
  Ends ends;
  for (std::size_t c = 0; c < 3; ++c) {
    ends.first[c] = to_8_bits(bits.take(7), 7);
    ends.second[c] = to_8_bits(bits.take(7), 7);
  }
  ends.first[3] = bits.take(8);
  ends.second[3] = bits.take(8);
  std::array<int, 16> colors{}, alphas{};
  for (std::size_t i = 0; i < 16; ++i) colors[i] = bits.take(i == 0 ? 1 : 2);
  for (std::size_t i = 0; i < 16; ++i) alphas[i] = bits.take(i == 0 ? 1 : 2);
  for (std::size_t i = 0; i < 16; ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const int index = c == 3 ? alphas[i] : colors[i];
      block.rgba[4 * i + c] = between(ends.first[c], ends.second[c], weight(index, 2));
    }
    if (rotation > 0) {
      std::swap(block.rgba[4 * i + 3], block.rgba[4 * i + static_cast<std::size_t>(rotation) - 1]);
    }
  }
}

struct Layout {
  int subsets;
  std::size_t channels;
  int color_bits;      // without the p-bit
  bool shared_p_bits;  // one for both ends
  int index_bits;
};

void decode_lines(BlockBits& bits, const Layout& layout, DecodedBlock& block) {
  if (layout.subsets == 2) block.partition = bits.take(6);
  std::array<Ends, 2> ends;
  const auto subsets = static_cast<std::size_t>(layout.subsets);
  for (std::size_t c = 0; c < layout.channels; ++c) {
    for (std::size_t s = 0; s < subsets; ++s) {
      ends[s].first[c] = bits.take(layout.color_bits);
      ends[s].second[c] = bits.take(layout.color_bits);
    }
  }
  for (std::size_t s = 0; s < subsets; ++s) {
    const int first = bits.take(1);
    const int second = layout.shared_p_bits ? first : bits.take(1);
    for (std::size_t c = 0; c < layout.channels; ++c) {
      ends[s].first[c] = to_8_bits(2 * ends[s].first[c] + first, layout.color_bits + 1);
      ends[s].second[c] = to_8_bits(2 * ends[s].second[c] + second, layout.color_bits + 1);
    }
  }
  for (int i = 0; i < 16; ++i) {
    const bool second = block.partition >= 0 && partitions[block.partition][i] == '1';
    const bool anchor = i == 0 || (block.partition >= 0 && i == anchors_of_second[block.partition]);
    const int index = bits.take(layout.index_bits - (anchor ? 1 : 0));
    const Ends& line = ends[second ? 1 : 0];
    for (std::size_t c = 0; c < 4; ++c) {
      block.rgba[4 * static_cast<std::size_t>(i) + c] =
          between(line.first[c], line.second[c], weight(index, layout.index_bits));
    }
  }
}

}  // namespace

DecodedBlock decode_bc7(std::span<const std::uint8_t, 16> block) {
  BlockBits bits(block);
  DecodedBlock decoded;
  while (decoded.mode < 8 && bits.take(1) == 0) ++decoded.mode;
  switch (decoded.mode) {
    case 1:
      decode_lines(bits, {2, 3, 6, true, 3}, decoded);
      return decoded;
    case 3:
      decode_lines(bits, {2, 3, 7, false, 2}, decoded);
      return decoded;
    case 5:
      decode_mode_5(bits, decoded);
      return decoded;
    case 6:
      decode_lines(bits, {1, 4, 7, false, 4}, decoded);
      return decoded;
    case 7:
      decode_lines(bits, {2, 4, 5, false, 2}, decoded);
      return decoded;
    default:
      throw std::invalid_argument("a BC7 block of mode " + std::to_string(decoded.mode));
  }
}

const char* two_subset_partition(int number) {
  return partitions[number];
}

}  // namespace heliograph::scene::test
