#pragma once

#include <cstdint>
#include <span>

#include "scene/image/image_size.hpp"

namespace heliograph::scene {

bool is_ktx2(std::span<const std::uint8_t> file);

/// @throws ImportError when the header is damaged, or is not of an image that KHR_texture_basisu
/// permits: two-dimensional, of ETC1S or UASTC blocks
ImageSize probe_ktx2(std::span<const std::uint8_t> file);

/// The largest level; see decode_image. @throws ImportError
void decode_ktx2(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba);

}  // namespace heliograph::scene
