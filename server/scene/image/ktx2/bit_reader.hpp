#pragma once

#include <cstdint>
#include <span>

#include "scene/import_error.hpp"

namespace heliograph::scene::ktx2 {

/// Bits in the order of their significance, from the first byte on.
class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// The next `count` bits, at most 16. @throws ImportError past the end
  std::uint32_t read(std::uint32_t count) {
    while (available_ < count) {
      if (next_ == bytes_.size()) throw ImportError("is a damaged KTX2: its data end early");
      bits_ |= std::uint32_t(bytes_[next_++]) << available_;
      available_ += 8;
    }
    const std::uint32_t value = bits_ & ((1u << count) - 1u);
    bits_ >>= count;
    available_ -= count;
    return value;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
  std::uint32_t bits_ = 0;
  std::uint32_t available_ = 0;
};

}  // namespace heliograph::scene::ktx2
