#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace heliograph::scene {

struct ImageSize {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// No picture wider or higher than this is opened.
inline constexpr std::uint32_t largest_image_side = 8192;

/// Size of a PNG or JPEG picture, from its header alone.
/// @throws ImportError when it is neither, or has no pixels
ImageSize probe_image(std::span<const std::uint8_t> file);

/// Decodes a PNG or JPEG picture of the probed `size` into `rgba`, 4 bytes a pixel, row 0 on top;
/// 16-bit channels are reduced to 8. Memory stays in proportion to `size`, whatever the file inflates to.
/// @throws ImportError when the data is cut or damaged
void decode_image(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba);

/// Size of a Radiance .hdr picture. @throws ImportError
ImageSize probe_radiance(std::span<const std::uint8_t> file);

/// Decodes a Radiance .hdr picture of the probed `size`: linear RGB, row 0 on top.
/// @throws ImportError when the data is cut or damaged
std::vector<glm::vec3> decode_radiance(std::span<const std::uint8_t> file, ImageSize size);

}  // namespace heliograph::scene
