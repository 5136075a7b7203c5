#pragma once

#include <cstdint>
#include <span>

#include "scene/image/image_size.hpp"

namespace heliograph::scene {

bool is_png(std::span<const std::uint8_t> file);
/// @throws ImportError when the header is damaged
ImageSize probe_png(std::span<const std::uint8_t> file);
/// As decode_image. @throws ImportError
void decode_png(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba);

}  // namespace heliograph::scene
