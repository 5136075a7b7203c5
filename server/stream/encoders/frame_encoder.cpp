#include "stream/encoders/frame_encoder.hpp"

#include <algorithm>
#include <utility>

#include "stream/encoders/png_encoder.hpp"

namespace heliograph::stream {

using protocol::FrameCodec;
using protocol::StillFormat;

namespace {

constexpr int lossless_quality = 100;
constexpr std::chrono::seconds longest_unused{10};

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
  const PictureView scaled = scaler_.scale(picture, request.form.scale);
  if (request.form.codec == protocol::StreamCodec::jpeg) return encode_jpeg(scaled, request.form);
  if (scaled.width < 2 || scaled.height < 2) {
    return encode_jpeg(scaled, FormPlanner::stand_in(request.form));
  }
  return encode_video(scaled, request);
}

std::shared_ptr<EncodedFrame> PictureEncoder::encode_jpeg(const PictureView& picture,
                                                          const Form& form) {
  auto frame = independent_frame(picture, FrameCodec::jpeg, form.quality);
  frame->form = form;
  frame->payload = jpeg_.encode(picture, form.quality, ChromaSampling::half);
  return frame;
}

std::shared_ptr<EncodedFrame> PictureEncoder::encode_video(const PictureView& picture,
                                                           const FormRequest& request) {
  Video& video = video_for(request.form, picture);
  const bool key = request.key || video.next.index == 0;
  H264Encoder::Unit unit = video.encoder->encode(
      picture, {.quality = request.form.quality, .max_bytes_per_frame = request.max_bytes}, key);
  auto frame = std::make_shared<EncodedFrame>();
  frame->header.codec = FrameCodec::h264;
  if (unit.key) frame->header.flags = protocol::frame_flag::key;
  frame->header.quality = static_cast<std::uint16_t>(request.form.quality);
  frame->header.width = static_cast<std::uint16_t>(video.encoder->width());
  frame->header.height = static_cast<std::uint16_t>(video.encoder->height());
  frame->form = request.form;
  frame->video = video.next;
  ++video.next.index;
  frame->payload = std::move(unit.bytes);
  return frame;
}

PictureEncoder::Video& PictureEncoder::video_for(const Form& form, const PictureView& picture) {
  const Clock::time_point now = Clock::now();
  std::erase_if(videos_, [&](const auto& entry) {
    return entry.first != form && now > entry.second.used_at + longest_unused;
  });
  Video& video = videos_[form];
  video.used_at = now;
  if (!video.encoder || video.width != picture.width || video.height != picture.height) {
    video.encoder = std::make_unique<H264Encoder>(picture.width, picture.height);
    video.width = picture.width;
    video.height = picture.height;
    video.next = {.video = ++videos_so_far_, .index = 0};
  }
  return video;
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
