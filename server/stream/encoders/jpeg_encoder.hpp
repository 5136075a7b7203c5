#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// Resolution of the colour channels: half is 4:2:0, full is 4:4:4.
enum class ChromaSampling { half, full };

/// Encodes images with libjpeg-turbo; reuses its state and buffer. One thread at a time.
class JpegEncoder {
 public:
  /// @throws std::runtime_error if the library cannot be initialized
  JpegEncoder();
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// A JPEG file; `quality` from 1 to 100.
  /// @throws std::runtime_error if the image is incomplete or larger than JPEG allows
  std::vector<std::uint8_t> encode(const ImageView& image, int quality, ChromaSampling sampling);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::stream
