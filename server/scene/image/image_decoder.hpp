#pragma once

#include <cstdint>
#include <span>

namespace heliograph::scene {

struct ImageSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool operator==(const ImageSize&) const = default;
};

/// No picture wider or higher than this is opened.
inline constexpr std::uint32_t largest_image_side = 8192;

/// No environment has more pixels than this: twice as wide as high, as far as that goes.
inline constexpr std::uint64_t most_environment_pixels =
    std::uint64_t{largest_image_side} * largest_image_side / 2;

/// Size of a PNG, JPEG or WebP picture, from its header alone.
/// @throws ImportError when it is none of these, or has no pixels
ImageSize probe_image(std::span<const std::uint8_t> file);

/// Decodes such a picture of the probed `size` into `rgba`, 4 bytes a pixel, row 0 on top;
/// 16-bit channels are reduced to 8. Colour profiles and gamma in the file are ignored, as glTF
/// 3.8.2 asks. Memory stays in proportion to `size`, whatever the file inflates to.
/// @throws ImportError when the data is cut or damaged
void decode_image(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba);

}  // namespace heliograph::scene
