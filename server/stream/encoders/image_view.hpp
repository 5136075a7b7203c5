#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace heliograph::stream {

/// Pixels to encode, owned by someone else: sRGB, 4 bytes each, tightly packed, row 0 on top.
/// Alpha is ignored: pictures are opaque.
struct PictureView {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::span<const std::uint8_t> rgba;

  /// Whether there is a picture and `rgba` holds exactly its pixels.
  bool complete() const {
    return width > 0 && height > 0 && rgba.size() == std::size_t{4} * width * height;
  }
};

}  // namespace heliograph::stream
