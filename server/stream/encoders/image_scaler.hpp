#pragma once

#include <cstdint>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// Downscales images with a box filter: each pixel is the mean of the area that it covers. Reuses
/// its memory. One thread at a time.
class ImageScaler {
 public:
  /// `percent` of width and height, 1 to 100. The result is valid until the next call.
  ImageView scale(const ImageView& image, int percent);

 private:
  std::vector<std::uint8_t> pixels_;
  std::vector<float> row_;
};

}  // namespace heliograph::stream
