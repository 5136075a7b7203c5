#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// Levels from `width` x `height` down to 1 x 1.
std::uint32_t mip_level_count(std::uint32_t width, std::uint32_t height);

/// Bytes of all levels at 4 bytes a pixel.
std::uint64_t mip_chain_bytes(std::uint32_t width, std::uint32_t height);

/// Fills levels 1.. of an image whose level 0 is there and whose `pixels` holds the whole chain.
/// Box filter over the exact footprint of each pixel, odd sizes included; sRGB colours are averaged
/// as light, alpha and data as they are.
void fill_mip_chain(Image& image);

}  // namespace heliograph::scene
