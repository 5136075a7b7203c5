#pragma once

#include <cstddef>
#include <cstdint>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// One channel of a video frame; rows are `stride` bytes apart.
struct Plane {
  std::uint8_t* samples = nullptr;
  std::size_t stride = 0;
};

/// 4:2:0: the colour planes have half the width and height.
struct VideoPlanes {
  Plane luma;
  Plane blue;
  Plane red;
};

/// Converts to Y'CbCr of ITU-R BT.709 with limited range (16 to 235, 16 to 240); colours are the
/// mean of 2x2 pixels. An odd last column or row is cropped.
void to_video_planes(const ImageView& image, const VideoPlanes& planes);

}  // namespace heliograph::stream
