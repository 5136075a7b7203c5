#include "stream/encoders/frame_encoder.hpp"

#include <algorithm>
#include <utility>

#include "stream/encoders/png_encoder.hpp"

namespace heliograph::stream {

using protocol::FrameCodec;
using protocol::StillFormat;

namespace {

constexpr int lossless_quality = 100;
constexpr std::chrono::seconds max_unused{10};

std::shared_ptr<EncodedFrame> independent_frame(std::uint32_t width, std::uint32_t height,
                                                FrameCodec codec, int quality) {
  auto frame = std::make_shared<EncodedFrame>();
  frame->header.codec = codec;
  frame->header.flags = protocol::frame_flag::key;
  frame->header.quality = static_cast<std::uint16_t>(quality);
  frame->header.width = static_cast<std::uint16_t>(width);
  frame->header.height = static_cast<std::uint16_t>(height);
  return frame;
}

}  // namespace

std::shared_ptr<EncodedFrame> FrameEncoder::encode(const ImageView& image,
                                                   const VariantRequest& request) {
  const ImageView scaled = scaler_.scale(image, request.variant.scale);
  if (request.variant.codec == protocol::StreamCodec::jpeg)
    return encode_jpeg(scaled, request.variant);
  if (scaled.width < 2 || scaled.height < 2) {
    return encode_jpeg(scaled, VariantPlanner::jpeg_fallback(request.variant));
  }
  return encode_video(scaled, request);
}

std::shared_ptr<EncodedFrame> FrameEncoder::encode_jpeg(const ImageView& image,
                                                        const EncodingVariant& variant) {
  return wrap_jpeg(image.width, image.height, variant,
                   jpeg_.encode(image, variant.quality, ChromaSampling::half));
}

std::shared_ptr<EncodedFrame> FrameEncoder::wrap_jpeg(std::uint32_t width, std::uint32_t height,
                                                      const EncodingVariant& variant,
                                                      std::vector<std::uint8_t> bytes) {
  auto frame = independent_frame(width, height, FrameCodec::jpeg, variant.quality);
  frame->variant = variant;
  frame->payload = std::move(bytes);
  return frame;
}

std::shared_ptr<EncodedFrame> FrameEncoder::encode_video(const ImageView& image,
                                                         const VariantRequest& request) {
  Video& video = video_for(request.variant, image);
  const bool key = request.key || video.next.index == 0;
  H264Encoder::Unit unit = video.encoder->encode(
      image, {.quality = request.variant.quality, .max_bytes_per_frame = request.max_bytes}, key);
  auto frame = std::make_shared<EncodedFrame>();
  frame->header.codec = FrameCodec::h264;
  if (unit.key) frame->header.flags = protocol::frame_flag::key;
  frame->header.quality = static_cast<std::uint16_t>(request.variant.quality);
  frame->header.width = static_cast<std::uint16_t>(video.encoder->width());
  frame->header.height = static_cast<std::uint16_t>(video.encoder->height());
  frame->variant = request.variant;
  frame->video = video.next;
  ++video.next.index;
  frame->payload = std::move(unit.bytes);
  return frame;
}

FrameEncoder::Video& FrameEncoder::video_for(const EncodingVariant& variant,
                                             const ImageView& image) {
  const Clock::time_point now = Clock::now();
  std::erase_if(videos_, [&](const auto& entry) {
    return entry.first != variant && now > entry.second.used_at + max_unused;
  });
  Video& video = videos_[variant];
  video.used_at = now;
  if (!video.encoder || video.width != image.width || video.height != image.height) {
    video.encoder = std::make_unique<H264Encoder>(image.width, image.height);
    video.width = image.width;
    video.height = image.height;
    video.next = {.video = ++video_count_, .index = 0};
  }
  return video;
}

std::shared_ptr<EncodedFrame> FrameEncoder::encode_still(const ImageView& image, StillFormat format,
                                                         int quality) {
  const bool lossless = format == StillFormat::png;
  const int used = lossless ? lossless_quality : std::max(still_quality, quality);
  auto frame = independent_frame(image.width, image.height,
                                 lossless ? FrameCodec::png : FrameCodec::jpeg, used);
  frame->header.flags |= protocol::frame_flag::final;
  frame->variant.quality = used;
  frame->payload = lossless ? encode_png(image) : jpeg_.encode(image, used, ChromaSampling::full);
  return frame;
}

}  // namespace heliograph::stream
