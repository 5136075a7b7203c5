#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// The image as a lossy WebP file; `quality` from 1 to 100.
/// @throws std::runtime_error if the image is incomplete or larger than WebP allows
std::vector<std::uint8_t> encode_webp(const ImageView& image, int quality,
                                      Alpha alpha = Alpha::ignored);

/// Animated WebP, repeated without end. All frames have one size.
class WebpAnimation {
 public:
  /// @throws std::runtime_error if the library cannot be initialized
  WebpAnimation(std::uint32_t width, std::uint32_t height, double fps, int quality, Alpha alpha);
  ~WebpAnimation();
  WebpAnimation(const WebpAnimation&) = delete;
  WebpAnimation& operator=(const WebpAnimation&) = delete;

  /// @throws std::runtime_error, also if the image has another size
  void add(const ImageView& image);
  /// The file of all frames.
  std::vector<std::uint8_t> finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::stream
