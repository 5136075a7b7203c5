#include "stream/encoders/h264_encoder.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <stdexcept>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
}

#include "stream/encoders/video_planes.hpp"

namespace heliograph::stream {
namespace {

constexpr const char* encoder_name = "libx264";

// Nominal frame rate, for the rate control only: frames arrive at any rate.
constexpr int nominal_rate = 30;
constexpr int frames_in_buffer = 3;  // maximum frame size in multiples of the average
constexpr int no_regular_key_frames = 1 << 30;

struct ContextDeleter {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
};
struct FrameDeleter {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct PacketDeleter {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};

void check(int result, const char* what) {
  if (result >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
  av_strerror(result, reason.data(), reason.size());
  throw std::runtime_error(std::string("H.264: ") + what + ": " + reason.data());
}

/// Level 4.2 allows 1920x1080 at 60 frames per second, 5.2 the same for 3840x2160 (H.264 table
///
struct Level {
  int number;
  double bits_per_second;  // limit of the high profile
};

Level level_for(std::uint32_t width, std::uint32_t height) {
  if (width * height <= 1920 * 1088) return {.number = 42, .bits_per_second = 62.5e6};
  return {.number = 52, .bits_per_second = 300e6};
}

/// x264's constant rate factor: 21 for a quality of 80, 15 for 100, 30 for 50.
double rate_factor(int quality) {
  return 45.0 - 0.3 * std::clamp(quality, 1, 100);
}

}  // namespace

const std::optional<std::string>& h264_unavailable() {
  static const std::optional<std::string> reason = []() -> std::optional<std::string> {
    if (avcodec_find_encoder_by_name(encoder_name)) return std::nullopt;
    return "the server's libavcodec has no " + std::string(encoder_name) + " encoder for H.264";
  }();
  return reason;
}

struct H264Encoder::State {
  std::unique_ptr<AVCodecContext, ContextDeleter> context;
  std::unique_ptr<AVFrame, FrameDeleter> frame;
  std::unique_ptr<AVPacket, PacketDeleter> packet;
  double most_bytes_per_frame = 0.0;
  std::int64_t count = 0;

  void set_rate(const H264Rate& rate) {
    const double bytes = std::min(rate.max_bytes_per_frame, most_bytes_per_frame);
    // libavcodec applies changed options to the running encoder.
    context->rc_max_rate = static_cast<std::int64_t>(bytes * 8 * nominal_rate);
    context->rc_buffer_size = static_cast<int>(bytes * 8 * frames_in_buffer);
    av_opt_set_double(context->priv_data, "crf", rate_factor(rate.quality), 0);
  }
};

H264Encoder::H264Encoder(std::uint32_t width, std::uint32_t height)
    : state_(std::make_unique<State>()) {
  static std::once_flag quiet;
  std::call_once(quiet, [] { av_log_set_level(AV_LOG_FATAL); });
  const AVCodec* const codec = avcodec_find_encoder_by_name(encoder_name);
  if (!codec) throw std::runtime_error(*h264_unavailable());
  state_->context.reset(avcodec_alloc_context3(codec));
  state_->frame.reset(av_frame_alloc());
  state_->packet.reset(av_packet_alloc());
  if (!state_->context || !state_->frame || !state_->packet) throw std::bad_alloc();

  AVCodecContext& context = *state_->context;
  context.width = static_cast<int>(width & ~1u);
  context.height = static_cast<int>(height & ~1u);
  if (context.width == 0 || context.height == 0) {
    throw std::runtime_error("H.264: images must be at least 2 x 2 pixels");
  }
  context.pix_fmt = AV_PIX_FMT_YUV420P;
  context.color_range = AVCOL_RANGE_MPEG;
  context.colorspace = AVCOL_SPC_BT709;
  context.color_primaries = AVCOL_PRI_BT709;
  context.color_trc = AVCOL_TRC_IEC61966_2_1;
  context.time_base = {1, nominal_rate};
  context.framerate = {nominal_rate, 1};
  context.gop_size = no_regular_key_frames;
  context.max_b_frames = 0;
  context.thread_count = 1;
  const Level level = level_for(width, height);
  context.level = level.number;
  state_->most_bytes_per_frame = level.bits_per_second / 8 / nominal_rate;
  check(av_opt_set(context.priv_data, "preset", "superfast", 0), "preset");
  check(av_opt_set(context.priv_data, "tune", "zerolatency", 0), "tune");
  check(av_opt_set(context.priv_data, "profile", "high", 0), "profile");
  check(av_opt_set_int(context.priv_data, "forced-idr", 1, 0), "forced-idr");
  check(av_opt_set(context.priv_data, "x264-params", "scenecut=0", 0), "scenecut");
  state_->set_rate({.max_bytes_per_frame = state_->most_bytes_per_frame});
  check(avcodec_open2(&context, codec, nullptr), "cannot start the encoder");

  AVFrame& frame = *state_->frame;
  frame.format = context.pix_fmt;
  frame.width = context.width;
  frame.height = context.height;
  check(av_frame_get_buffer(&frame, 0), "cannot allocate an image");
}

H264Encoder::~H264Encoder() = default;

H264Encoder::Unit H264Encoder::encode(const ImageView& image, const H264Rate& rate, bool key) {
  AVCodecContext& context = *state_->context;
  AVFrame& frame = *state_->frame;
  if (!image.complete() || (image.width & ~1u) != width() || (image.height & ~1u) != height()) {
    throw std::runtime_error("H.264: the image does not have the size of the video");
  }
  check(av_frame_make_writable(&frame), "cannot allocate an image");
  const auto plane = [&](int i) {
    return Plane{.samples = frame.data[i], .stride = static_cast<std::size_t>(frame.linesize[i])};
  };
  to_video_planes(image, {.luma = plane(0), .blue = plane(1), .red = plane(2)});
  frame.pts = state_->count++;
  frame.pict_type = key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
  state_->set_rate(rate);
  check(avcodec_send_frame(&context, &frame), "encoding");
  check(avcodec_receive_packet(&context, state_->packet.get()), "encoding");
  const AVPacket& packet = *state_->packet;
  Unit unit{.bytes = {packet.data, packet.data + packet.size},
            .key = (packet.flags & AV_PKT_FLAG_KEY) != 0};
  av_packet_unref(state_->packet.get());
  return unit;
}

std::uint32_t H264Encoder::width() const {
  return static_cast<std::uint32_t>(state_->context->width);
}

std::uint32_t H264Encoder::height() const {
  return static_cast<std::uint32_t>(state_->context->height);
}

}  // namespace heliograph::stream
