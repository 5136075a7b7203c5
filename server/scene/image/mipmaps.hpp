#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "scene/image/image_size.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// Number of levels from `width` x `height` down to 1 x 1.
std::uint32_t mip_level_count(std::uint32_t width, std::uint32_t height);

/// Bytes of all levels at 4 bytes a pixel.
std::uint64_t mip_chain_bytes(std::uint32_t width, std::uint32_t height);

/// Texels of the levels of an image before `level`, in bytes.
std::uint64_t level_offset(const Image& image, std::uint32_t level);

/// The first of the last levels of an image, which take so many bytes.
std::uint32_t first_level_in(const Image& image, std::uint64_t bytes);

/// The first level no side of which is longer than `longest_side`; the last where none is.
std::uint32_t first_level_within(const Image& image, std::uint32_t longest_side);

/// Which levels of a scene's images are needed: those with no longer side, and of them only as many
/// that all images together have no more texels.
struct KeptTextures {
  std::uint32_t longest_side = largest_image_side;
  std::uint64_t most_texels = std::numeric_limits<std::uint64_t>::max();
};

/// The longest side of these levels; nullopt where not even the smallest levels fit.
std::optional<std::uint32_t> longest_side_that_fits(std::span<const Image> images,
                                                    const KeptTextures& kept);

/// Computes levels 1.. of an image from level 0; `pixels` has room for the whole chain. Box filter
/// over the exact footprint of each pixel, odd sizes included; sRGB colors are averaged in linear
/// space, alpha and data as stored.
void fill_mip_chain(Image& image);

}  // namespace heliograph::scene
