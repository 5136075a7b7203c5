#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// Why H.264 cannot be encoded here; nullopt if it can.
const std::optional<std::string>& h264_unavailable();

struct H264Rate {
  int quality = 80;            // on the scale of JPEG
  double max_bytes_per_frame;  // average over a few frames
};

/// Encodes low-latency video: H.264 Annex B without B-frames, one frame out for each frame in, key
/// frames only on request, preceded by parameter sets. 4:2:0, BT.709, limited range, as the
/// parameter sets say. One thread at a time.
class H264Encoder {
 public:
  /// Images of `width` x `height` pixels; an odd last column or row is cropped.
  /// @throws std::runtime_error if libavcodec has no H.264 encoder
  H264Encoder(std::uint32_t width, std::uint32_t height);
  ~H264Encoder();
  H264Encoder(const H264Encoder&) = delete;
  H264Encoder& operator=(const H264Encoder&) = delete;

  struct Unit {
    std::vector<std::uint8_t> bytes;
    bool key = false;
  };
  /// The next frame. @throws std::runtime_error, also if the image has another size
  Unit encode(const ImageView& image, const H264Rate& rate, bool key);

  std::uint32_t width() const;  // of the encoded image
  std::uint32_t height() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::stream
