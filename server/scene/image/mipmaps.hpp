#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// Number of levels from `width` x `height` down to 1 x 1.
std::uint32_t mip_level_count(std::uint32_t width, std::uint32_t height);

/// Bytes of all levels at 4 bytes a pixel.
std::uint64_t mip_chain_bytes(std::uint32_t width, std::uint32_t height);

/// Computes levels 1.. of an image from level 0; `pixels` has room for the whole chain. Box filter
/// over the exact footprint of each pixel, odd sizes included; sRGB colors are averaged in linear
/// space, alpha and data as stored.
void fill_mip_chain(Image& image);

}  // namespace heliograph::scene
