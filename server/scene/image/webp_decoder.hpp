#pragma once

#include <cstdint>
#include <span>

#include "scene/image/image_size.hpp"

namespace heliograph::scene {

bool is_webp(std::span<const std::uint8_t> file);

/// @throws ImportError when the header is damaged or the image is animated
ImageSize probe_webp(std::span<const std::uint8_t> file);

/// See decode_image. @throws ImportError
void decode_webp(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba);

}  // namespace heliograph::scene
