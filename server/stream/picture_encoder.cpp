#include "stream/picture_encoder.hpp"

#include <algorithm>

#include "stream/png_encoder.hpp"

namespace heliograph::stream {

using protocol::FrameCodec;
using protocol::StillFormat;

namespace {

constexpr int lossless_quality = 100;

std::shared_ptr<EncodedFrame> independent_frame(const PictureView& picture, FrameCodec codec,
                                                int quality) {
  auto frame = std::make_shared<EncodedFrame>();
  frame->header.codec = codec;
  frame->header.flags = protocol::frame_flag::key;
  frame->header.quality = static_cast<std::uint16_t>(quality);
  frame->header.width = static_cast<std::uint16_t>(picture.width);
  frame->header.height = static_cast<std::uint16_t>(picture.height);
  return frame;
}

}  // namespace

std::shared_ptr<EncodedFrame> PictureEncoder::encode(const PictureView& picture,
                                                     const FormRequest& request) {
  auto frame = independent_frame(picture, FrameCodec::jpeg, request.form.quality);
  frame->form = request.form;
  frame->payload = jpeg_.encode(picture, request.form.quality, ChromaSampling::half);
  return frame;
}

std::shared_ptr<EncodedFrame> PictureEncoder::encode_still(const PictureView& picture,
                                                           StillFormat format, int quality) {
  const bool lossless = format == StillFormat::png;
  const int used = lossless ? lossless_quality : std::max(still_quality, quality);
  auto frame = independent_frame(picture, lossless ? FrameCodec::png : FrameCodec::jpeg, used);
  frame->header.flags |= protocol::frame_flag::final;
  frame->form.quality = used;
  frame->payload =
      lossless ? encode_png(picture) : jpeg_.encode(picture, used, ChromaSampling::full);
  return frame;
}

}  // namespace heliograph::stream
