#pragma once

#include <cstdint>

namespace heliograph::scene {

struct ImageSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool operator==(const ImageSize&) const = default;
};

/// Largest accepted width and height of an image, pixels.
inline constexpr std::uint32_t largest_image_side = 8192;

/// Largest accepted number of pixels of an environment, which is twice as wide as high.
inline constexpr std::uint64_t most_environment_pixels =
    std::uint64_t{largest_image_side} * largest_image_side / 2;

}  // namespace heliograph::scene
