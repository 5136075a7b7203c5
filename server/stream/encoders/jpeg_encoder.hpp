#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// Resolution of the colour channels: half is 4:2:0, full is 4:4:4.
enum class ChromaSampling { half, full };

/// Encodes images with libjpeg-turbo; reuses its states and buffers, one for each of the threads
/// that encode at the same time. Thread safe.
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
  std::unique_ptr<State> take();
  void give_back(std::unique_ptr<State> state);

  std::mutex mutex_;
  std::vector<std::unique_ptr<State>> free_;
};

}  // namespace heliograph::stream
