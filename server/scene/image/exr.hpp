#pragma once

#include <cstdint>
#include <span>

#include "scene/environment.hpp"
#include "scene/image/image_decoder.hpp"

namespace heliograph::scene {

/// Whether a file begins like an OpenEXR picture.
bool is_exr(std::span<const std::uint8_t> file);

/// Decodes the first part of an OpenEXR picture: scan lines or tiles, any compression, half, float
/// or whole numbers, with channels R, G and B (of a layer, where the picture has none of its own),
/// luminance and chroma, or Y alone.
/// @throws ImportError, also when there are more than `most_pixels`
Environment decode_exr(std::span<const std::uint8_t> file,
                       std::uint64_t most_pixels = most_environment_pixels);

}  // namespace heliograph::scene
