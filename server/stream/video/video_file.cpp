#include "stream/video/video_file.hpp"

#include <array>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include "stream/encoders/video_planes.hpp"

namespace heliograph::stream {
namespace {

/// What a container takes, and the encoder's options. The number of threads is fixed, so that the
/// same frames give the same bytes on every machine; they encode while the next frame is rendered.
struct VideoFormat {
  const char* muxer;
  const char* encoder;
  const char* crf;  // constant rate factor, of the encoder's own scale
  std::vector<std::array<const char*, 2>> options;
};

const VideoFormat& video_format(VideoContainer container) {
  // x264's macroblock tree reads memory that it has not written, for some widths. Without it this
  // rate factor gives the size and similarity that 18 gives with it.
  static const VideoFormat mp4{
      "mp4",
      "libx264",
      "20",
      {{"preset", "medium"}, {"profile", "high"}, {"x264-params", "mbtree=0"}}};
  static const VideoFormat webm{
      "webm", "libvpx-vp9", "24", {{"deadline", "good"}, {"cpu-used", "4"}}};
  return container == VideoContainer::mp4 ? mp4 : webm;
}

void check_video(int result, const std::string& what) {
  if (result >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
  av_strerror(result, reason.data(), reason.size());
  throw std::runtime_error("video: " + what + ": " + reason.data());
}

struct FormatDeleter {
  void operator()(AVFormatContext* context) const {
    if (context->pb) avio_closep(&context->pb);
    avformat_free_context(context);
  }
};
struct CodecDeleter {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
};
struct ImageDeleter {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct DataDeleter {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};

}  // namespace

struct VideoFile::State {
  std::unique_ptr<AVFormatContext, FormatDeleter> file;
  std::unique_ptr<AVCodecContext, CodecDeleter> codec;
  std::unique_ptr<AVFrame, ImageDeleter> frame;
  std::unique_ptr<AVPacket, DataDeleter> packet;
  AVStream* stream = nullptr;
  std::int64_t frames = 0;

  void open_encoder(const Options& options, const VideoFormat& format);
  void open_file(const std::string& path, const VideoFormat& format);
  /// Sends a frame, or the end for null, and writes what the encoder has ready.
  void encode(const AVFrame* image);
};

void VideoFile::State::open_encoder(const Options& options, const VideoFormat& format) {
  const AVCodec* const found = avcodec_find_encoder_by_name(format.encoder);
  if (!found) {
    throw std::runtime_error("video: libavcodec has no encoder " + std::string(format.encoder));
  }
  codec.reset(avcodec_alloc_context3(found));
  frame.reset(av_frame_alloc());
  packet.reset(av_packet_alloc());
  if (!codec || !frame || !packet) throw std::bad_alloc();
  codec->width = static_cast<int>(options.width & ~1u);
  codec->height = static_cast<int>(options.height & ~1u);
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->colorspace = AVCOL_SPC_BT709;
  codec->color_primaries = AVCOL_PRI_BT709;
  codec->color_trc = AVCOL_TRC_IEC61966_2_1;
  codec->framerate = av_d2q(options.fps, 1000);
  codec->time_base = av_inv_q(codec->framerate);
  codec->thread_count = 4;
  if (file->oformat->flags & AVFMT_GLOBALHEADER) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  check_video(av_opt_set(codec->priv_data, "crf", format.crf, 0), "crf");
  for (const auto& [name, value] : format.options) {
    check_video(av_opt_set(codec->priv_data, name, value, 0), name);
  }
  check_video(avcodec_open2(codec.get(), found, nullptr), "cannot start the encoder");
  frame->format = codec->pix_fmt;
  frame->width = codec->width;
  frame->height = codec->height;
  check_video(av_frame_get_buffer(frame.get(), 0), "cannot allocate an image");
}

void VideoFile::State::open_file(const std::string& path, const VideoFormat& format) {
  stream = avformat_new_stream(file.get(), nullptr);
  if (!stream) throw std::bad_alloc();
  check_video(avcodec_parameters_from_context(stream->codecpar, codec.get()), "parameters");
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  check_video(avio_open(&file->pb, path.c_str(), AVIO_FLAG_WRITE), "cannot write " + path);
  AVDictionary* options = nullptr;
  // A player can begin before it has the whole file.
  if (std::string(format.muxer) == "mp4") av_dict_set(&options, "movflags", "+faststart", 0);
  const int written = avformat_write_header(file.get(), &options);
  av_dict_free(&options);
  check_video(written, "cannot write " + path);
}

void VideoFile::State::encode(const AVFrame* image) {
  check_video(avcodec_send_frame(codec.get(), image), "encoding");
  while (true) {
    const int received = avcodec_receive_packet(codec.get(), packet.get());
    if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) return;
    check_video(received, "encoding");
    av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
    packet->stream_index = stream->index;
    check_video(av_interleaved_write_frame(file.get(), packet.get()), "cannot write");
  }
}

VideoFile::VideoFile(const std::filesystem::path& file, const Options& options)
    : state_(std::make_unique<State>()) {
  static std::once_flag quiet;
  std::call_once(quiet, [] { av_log_set_level(AV_LOG_FATAL); });
  const VideoFormat& format = video_format(options.container);
  if (options.width < 2 || options.height < 2) {
    throw std::runtime_error("video: images must be at least 2 x 2 pixels");
  }
  AVFormatContext* context = nullptr;
  check_video(avformat_alloc_output_context2(&context, nullptr, format.muxer, file.c_str()),
              "container");
  state_->file.reset(context);
  // No version of the library and no time in the file: the same frames give the same bytes.
  context->flags |= AVFMT_FLAG_BITEXACT;
  state_->open_encoder(options, format);
  state_->open_file(file.string(), format);
}

VideoFile::~VideoFile() = default;

void VideoFile::add(const ImageView& image) {
  AVFrame& frame = *state_->frame;
  if (!image.complete() || static_cast<int>(image.width & ~1u) != frame.width ||
      static_cast<int>(image.height & ~1u) != frame.height) {
    throw std::runtime_error("video: the image does not have the size of the video");
  }
  check_video(av_frame_make_writable(&frame), "cannot allocate an image");
  const auto plane = [&](int i) {
    return Plane{.samples = frame.data[i], .stride = static_cast<std::size_t>(frame.linesize[i])};
  };
  to_video_planes(image, {.luma = plane(0), .blue = plane(1), .red = plane(2)});
  frame.pts = state_->frames++;
  state_->encode(&frame);
}

void VideoFile::finish() {
  state_->encode(nullptr);
  check_video(av_write_trailer(state_->file.get()), "cannot finish the file");
  check_video(avio_closep(&state_->file->pb), "cannot finish the file");
}

}  // namespace heliograph::stream
