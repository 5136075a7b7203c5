#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace heliograph::scenes {

/// 8-bit image, rows from the top, `channels` bytes to a pixel (3 or 4).
struct Image {
  int width = 0;
  int height = 0;
  int channels = 3;
  std::vector<std::uint8_t> pixels;

  Image() = default;
  Image(int width_, int height_, int channels_)
      : width(width_),
        height(height_),
        channels(channels_),
        pixels(std::size_t(width_) * std::size_t(height_) * std::size_t(channels_)) {}

  std::uint8_t* at(int x, int y) {
    return &pixels[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels)];
  }
  const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

/// The bytes of a PNG file. Throws std::runtime_error where libpng fails.
std::vector<std::uint8_t> encode_png(const Image& image);

}  // namespace heliograph::scenes
