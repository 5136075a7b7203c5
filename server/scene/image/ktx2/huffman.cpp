#include "scene/image/ktx2/huffman.hpp"

#include <algorithm>

namespace heliograph::scene::ktx2 {
namespace {

[[noreturn]] void refuse() {
  throw ImportError("is a damaged KTX2: it has an invalid Huffman code");
}

/// A run of equal lengths: symbols 17 and up of the code of lengths.
struct Run {
  std::uint32_t bits;
  std::uint32_t least;
  bool of_zeros;
};

constexpr std::array<Run, 4> runs = {{{3, 3, true}, {7, 11, true}, {2, 3, false}, {7, 7, false}}};

constexpr std::array<std::uint8_t, 21> order_of_lengths = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                           11, 4,  12, 3,  13, 2, 14, 1, 15, 16};

}  // namespace

HuffmanCode::HuffmanCode(const std::vector<std::uint8_t>& lengths) {
  for (const std::uint8_t length : lengths) ++counts_[length];
  counts_[0] = 0;
  std::array<std::uint32_t, longest + 1> next{};
  std::int64_t free_codes = 1;
  for (std::size_t length = 1; length <= longest; ++length) {
    free_codes = 2 * free_codes - counts_[length];
    if (free_codes < 0) refuse();
    next[length] = next[length - 1] + counts_[length - 1];
  }
  symbols_.resize(next[longest] + counts_[longest]);
  for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
    if (lengths[symbol] == 0) continue;
    symbols_[next[lengths[symbol]]++] = static_cast<std::uint16_t>(symbol);
  }
}

HuffmanCode HuffmanCode::read(BitReader& bits) {
  const std::uint32_t symbols = bits.read(14);
  if (symbols == 0) return HuffmanCode({});
  const std::uint32_t used = bits.read(5);
  if (used < 1 || used > order_of_lengths.size()) refuse();
  std::vector<std::uint8_t> small(order_of_lengths.size());
  for (std::uint32_t i = 0; i < used; ++i) {
    small[order_of_lengths[i]] = static_cast<std::uint8_t>(bits.read(3));
  }
  const HuffmanCode code_of_lengths(small);
  std::vector<std::uint8_t> lengths;
  while (lengths.size() < symbols) {
    const std::uint32_t symbol = code_of_lengths.decode(bits);
    if (symbol <= longest) {
      lengths.push_back(static_cast<std::uint8_t>(symbol));
      continue;
    }
    const Run& run = runs[symbol - longest - 1];
    const std::uint32_t count = run.least + bits.read(run.bits);
    if (!run.of_zeros && (lengths.empty() || lengths.back() == 0)) refuse();
    if (count > symbols - lengths.size()) refuse();
    lengths.insert(lengths.end(), count, run.of_zeros ? std::uint8_t(0) : lengths.back());
  }
  return HuffmanCode(lengths);
}

std::uint32_t HuffmanCode::decode(BitReader& bits) const {
  std::uint32_t code = 0;
  std::uint32_t first = 0;
  std::uint32_t index = 0;
  for (std::size_t length = 1; length <= longest; ++length) {
    code |= bits.read(1);
    const std::uint32_t count = counts_[length];
    if (code - first < count) return symbols_[index + code - first];
    index += count;
    first = (first + count) << 1;
    code <<= 1;
  }
  refuse();
}

}  // namespace heliograph::scene::ktx2
