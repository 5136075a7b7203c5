#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/image/ktx2/bit_reader.hpp"

namespace heliograph::scene::ktx2 {

/// A canonical Huffman code, as in Deflate (RFC 1951), with codes of up to 16 bits.
class HuffmanCode {
 public:
  /// Reads a compressed table (KTX 2.0, "Compressed Huffman Tables"). @throws ImportError
  static HuffmanCode read(BitReader& bits);

  /// The next symbol. @throws ImportError when there is no such code
  std::uint32_t decode(BitReader& bits) const;

 private:
  static constexpr std::size_t longest = 16;

  explicit HuffmanCode(const std::vector<std::uint8_t>& lengths);

  std::array<std::uint32_t, longest + 1> counts_{};  // of symbols, by length
  std::vector<std::uint16_t> symbols_;               // in order of their codes
};

}  // namespace heliograph::scene::ktx2
