#pragma once

#include <cstdint>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// The image as a PNG file, 8 bit RGB, or RGBA where alpha is kept.
/// @throws std::runtime_error if the image is incomplete
std::vector<std::uint8_t> encode_png(const ImageView& image, Alpha alpha = Alpha::ignored);

}  // namespace heliograph::stream
