#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace heliograph::stream {

/// What becomes of an image's alpha: most formats are opaque.
enum class Alpha { ignored, kept };

/// Pixels to encode, not owned: sRGB, RGBA of 4 bytes, tightly packed, row 0 on top. Alpha is not
/// premultiplied, and ignored where an encoder does not ask for it.
struct ImageView {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::span<const std::uint8_t> rgba;

  /// Whether the size is not empty and `rgba` has exactly its pixels.
  bool complete() const {
    return width > 0 && height > 0 && rgba.size() == std::size_t{4} * width * height;
  }
};

}  // namespace heliograph::stream
