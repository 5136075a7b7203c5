#pragma once

#include <cstdint>
#include <span>

#include "scene/image/image_size.hpp"

namespace heliograph::scene {

/// Size of a PNG, JPEG, WebP or KTX2 image, from its header alone.
/// @throws ImportError when it is none of these, or has no pixels
ImageSize probe_image(std::span<const std::uint8_t> file);

/// Decodes a PNG, JPEG, WebP or KTX2 image of the probed `size` into RGBA8, top row first; 16-bit
/// channels are reduced to 8. Color profiles and gamma are ignored (glTF 3.8.2). Memory is bounded
/// by `size`, whatever the file inflates to.
/// @throws ImportError when the data is truncated or damaged
void decode_image(std::span<const std::uint8_t> file, ImageSize size, std::span<std::uint8_t> rgba);

}  // namespace heliograph::scene
