#pragma once

#include <cstdint>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// The picture as a PNG file, 8 bit RGB.
/// @throws std::runtime_error when the picture is incomplete
std::vector<std::uint8_t> encode_png(const PictureView& picture);

}  // namespace heliograph::stream
