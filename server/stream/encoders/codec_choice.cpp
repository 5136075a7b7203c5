#include "stream/encoders/codec_choice.hpp"

#include "stream/encoders/h264_encoder.hpp"

namespace heliograph::stream {

using protocol::StreamCodec;

CodecChoice choose_codec(const std::vector<std::string>& offered) {
  CodecChoice choice;
  for (const std::string& name : offered) {
    const auto codec = protocol::enum_value<StreamCodec>(name);
    if (codec == StreamCodec::jpeg) break;
    if (codec == StreamCodec::h264 && !h264_unavailable()) {
      choice.codec = *codec;
      break;
    }
    if (choice.reason) continue;
    choice.reason = codec ? *h264_unavailable() : "the server cannot encode " + name;
  }
  return choice;
}

}  // namespace heliograph::stream
