#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// How much colour a JPEG keeps: 4:2:0 halves its resolution in both directions.
enum class ChromaSampling { half, full };

/// Compresses pictures with libjpeg-turbo, keeping its state and buffer from one to the next.
/// One thread at a time.
class JpegEncoder {
 public:
  /// @throws std::runtime_error when the library cannot be set up
  JpegEncoder();
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// A JPEG file; `quality` from 1 to 100.
  /// @throws std::runtime_error when the picture is incomplete or larger than JPEG allows
  std::vector<std::uint8_t> encode(const PictureView& picture, int quality,
                                   ChromaSampling sampling);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::stream
