// Replaces h264_encoder.cpp in builds without libavcodec.
#include <stdexcept>

#include "stream/encoders/h264_encoder.hpp"

namespace heliograph::stream {

struct H264Encoder::State {};

const std::optional<std::string>& h264_unavailable() {
  static const std::optional<std::string> reason = "this server was built without H.264";
  return reason;
}

H264Encoder::H264Encoder(std::uint32_t, std::uint32_t) {
  throw std::runtime_error(*h264_unavailable());
}

H264Encoder::~H264Encoder() = default;

H264Encoder::Unit H264Encoder::encode(const ImageView&, const H264Rate&, bool) {
  return {};
}

std::uint32_t H264Encoder::width() const {
  return 0;
}

std::uint32_t H264Encoder::height() const {
  return 0;
}

}  // namespace heliograph::stream
