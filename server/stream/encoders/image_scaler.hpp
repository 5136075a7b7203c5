#pragma once

#include <cstdint>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// Makes pictures smaller; each pixel is the mean of the area that it covers. Keeps its memory from
/// one picture to the next. One thread at a time.
class PictureScaler {
 public:
  /// `percent` of width and height, from 1 to 100. What it gives lives until the next call.
  PictureView scale(const PictureView& picture, int percent);

 private:
  std::vector<std::uint8_t> pixels_;
  std::vector<float> row_;
};

}  // namespace heliograph::stream
