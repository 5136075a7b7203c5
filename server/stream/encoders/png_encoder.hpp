#pragma once

#include <cstdint>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

enum class PngAlpha { dropped, kept };

/// The image as a PNG file of 8 bits a channel, RGB or with `kept` RGBA.
/// @throws std::runtime_error if the image is incomplete
std::vector<std::uint8_t> encode_png(const ImageView& image, PngAlpha alpha = PngAlpha::dropped);

}  // namespace heliograph::stream
