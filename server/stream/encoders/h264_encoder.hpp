#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stream/encoders/image_view.hpp"

namespace heliograph::stream {

/// Why no H.264 can be encoded here, or nothing if it can.
const std::optional<std::string>& h264_unavailable();

struct H264Rate {
  int quality = 80;            // on the scale of JPEG
  double max_bytes_per_frame;  // on the average of a few frames
};

/// Encodes a video for viewers who want every picture at once: H.264 Annex B without B-frames, a
/// frame out for each one in, parameter sets before each key frame, which comes only on request.
/// 4:2:0, BT.709, limited range, as its parameter sets say. One thread at a time.
class H264Encoder {
 public:
  /// Pictures of `width` x `height` pixels; of odd ones the last column or row is left out.
  /// @throws std::runtime_error when libavcodec has no encoder for it
  H264Encoder(std::uint32_t width, std::uint32_t height);
  ~H264Encoder();
  H264Encoder(const H264Encoder&) = delete;
  H264Encoder& operator=(const H264Encoder&) = delete;

  struct Unit {
    std::vector<std::uint8_t> bytes;
    bool key = false;
  };
  /// The next frame. The picture has the encoder's size. @throws std::runtime_error
  Unit encode(const PictureView& picture, const H264Rate& rate, bool key);

  std::uint32_t width() const;  // of the coded picture
  std::uint32_t height() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace heliograph::stream
