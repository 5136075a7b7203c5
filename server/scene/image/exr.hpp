#pragma once

#include <cstdint>
#include <span>

#include "scene/environment.hpp"
#include "scene/image/image_size.hpp"

namespace heliograph::scene {

/// Whether a file starts with the magic number of OpenEXR.
bool is_exr(std::span<const std::uint8_t> file);

/// Decodes the first part of an OpenEXR image: scan lines or tiles, any compression, half, float or
/// uint, with channels R, G and B (of a layer if the image has none), luminance and chroma, or Y.
/// @throws ImportError, also when there are more than `most_pixels`
Environment decode_exr(std::span<const std::uint8_t> file,
                       std::uint64_t most_pixels = most_environment_pixels);

}  // namespace heliograph::scene
