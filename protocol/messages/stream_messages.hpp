#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/messages/stream_kinds.hpp"

// Messages about the frame stream: configuration, acknowledgements, statistics, captures.

namespace heliograph::protocol {

struct StreamConfigure {
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  std::optional<std::uint32_t> quality;
  std::optional<double> max_fps;
  std::optional<bool> paused;
  std::optional<StreamCodec> codec;
  std::optional<StillFormat> still;
  std::optional<bool> depth;

  static constexpr auto fields() {
    return std::tuple{
        field("width", &StreamConfigure::width,
              "Frame width that suits this viewer; frames suit all viewers.")
            .range(min_frame_size, max_frame_size)
            .unit("pixels"),
        field("height", &StreamConfigure::height, "Frame height that suits this viewer.")
            .range(min_frame_size, max_frame_size)
            .unit("pixels"),
        field("quality", &StreamConfigure::quality, "Quality on the scale of JPEG, for any codec.")
            .range(min_quality, max_quality),
        field("max_fps", &StreamConfigure::max_fps, "Maximum frame rate.")
            .range(min_frame_rate, max_frame_rate),
        field("paused", &StreamConfigure::paused, "Whether the stream is paused."),
        field("codec", &StreamConfigure::codec,
              "Codec of moving frames; one of those that hello returned."),
        field("still", &StreamConfigure::still,
              "Format of the final image of a static view: JPEG without chroma subsampling, or "
              "lossless PNG."),
        field("depth", &StreamConfigure::depth,
              "Whether frames carry their camera and a coarse depth plane, from which the client "
              "can show them from another camera."),
    };
  }
  bool operator==(const StreamConfigure&) const = default;
};

struct StreamState {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t quality = 0;
  double max_fps = 0.0;
  bool paused = false;
  StreamCodec codec = StreamCodec::jpeg;
  StillFormat still = StillFormat::jpeg;
  bool depth = false;

  static constexpr auto fields() {
    return std::tuple{
        field("width", &StreamState::width, "Frame width in effect.").unit("pixels"),
        field("height", &StreamState::height, "Frame height in effect.").unit("pixels"),
        field("quality", &StreamState::quality,
              "Requested quality; it is reduced on a slow connection."),
        field("max_fps", &StreamState::max_fps, "Maximum frame rate."),
        field("paused", &StreamState::paused, "Whether the stream is paused."),
        field("codec", &StreamState::codec, "Codec of moving frames."),
        field("still", &StreamState::still, "Format of the final image of a static view."),
        field("depth", &StreamState::depth, "Whether frames carry their camera and depth."),
    };
  }
  bool operator==(const StreamState&) const = default;
};

struct StreamAck {
  std::uint32_t frame_seq = 0;
  std::uint32_t decode_us = 0;
  std::uint32_t present_us = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("frame_seq", &StreamAck::frame_seq, "`frame_seq` of the frame's header."),
        field("decode_us", &StreamAck::decode_us, "Time that the client took to decode it.")
            .unit("microseconds")
            .or_default(),
        field("present_us", &StreamAck::present_us, "Time from its arrival to its display.")
            .unit("microseconds")
            .or_default(),
    };
  }
  bool operator==(const StreamAck&) const = default;
};

struct StatsSubscription {
  std::uint32_t interval_ms = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("interval_ms", &StatsSubscription::interval_ms,
              "Minimum time between two stats.frame notifications; 0: no notifications.")
            .range(0, 60000)
            .unit("milliseconds"),
    };
  }
  bool operator==(const StatsSubscription&) const = default;
};

struct PassTiming {
  std::string name;
  PassKind kind = PassKind::device;
  double ms = 0.0;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &PassTiming::name, "Name of the pass."),
        field("kind", &PassTiming::kind, "Where it ran: device (a shader) or host (the CPU)."),
        field("ms", &PassTiming::ms, "Duration.").unit("milliseconds"),
    };
  }
  bool operator==(const PassTiming&) const = default;
};

struct StatsFrame {
  std::uint32_t render_id = 0;
  double fps = 0.0;
  double frame_ms = 0.0;
  double encode_ms = 0.0;
  std::uint64_t bytes = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 0;
  TracerKind tracer = TracerKind::software;
  StreamPhase state = StreamPhase::interactive;
  StreamCodec codec = StreamCodec::jpeg;
  std::uint32_t quality = 0;
  double scale = 1.0;
  PassKind encoder = PassKind::host;
  double round_trip_ms = 0.0;
  double goodput = 0.0;
  std::vector<PassTiming> passes;

  static constexpr auto fields() {
    return std::tuple{
        field("render_id", &StatsFrame::render_id,
              "The rendered frame that the other members describe."),
        field("fps", &StatsFrame::fps, "Frames rendered in the last second."),
        field("frame_ms", &StatsFrame::frame_ms, "Time to render the frame.").unit("milliseconds"),
        field("encode_ms", &StatsFrame::encode_ms, "Time to encode the frame.")
            .unit("milliseconds"),
        field("bytes", &StatsFrame::bytes, "Size of the last frame sent to this viewer.")
            .unit("bytes"),
        field("width", &StatsFrame::width, "Frame width.").unit("pixels"),
        field("height", &StatsFrame::height, "Frame height.").unit("pixels"),
        field("samples", &StatsFrame::samples, "Samples accumulated per pixel."),
        field("tracer", &StatsFrame::tracer, "The ray tracer in use."),
        field("state", &StatsFrame::state,
              "interactive: follows changes; refining: refines a static view; idle: finished."),
        field("codec", &StatsFrame::codec, "Codec of moving frames chosen for this viewer."),
        field("quality", &StatsFrame::quality, "Quality of moving frames chosen for this viewer."),
        field("scale", &StatsFrame::scale,
              "Scale of moving frames chosen for this viewer, relative to the full size.")
            .range(0, 1),
        field("encoder", &StatsFrame::encoder,
              "What encoded the frame: the host, or the device that rendered it."),
        field("round_trip_ms", &StatsFrame::round_trip_ms,
              "Time from sending a frame to this viewer to its acknowledgement.")
            .unit("milliseconds"),
        field("goodput", &StatsFrame::goodput,
              "Measured throughput to this viewer while frames are in flight.")
            .unit("bytes per second"),
        field("passes", &StatsFrame::passes,
              "The passes in the order declared. GPUs time them in one frame of sixteen, and where "
              "one "
              "runs that was never timed; frames between repeat the newest times."),
    };
  }
  bool operator==(const StatsFrame&) const = default;
};

struct BufferInfo {
  std::string name;
  std::string description;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &BufferInfo::name, "Name for view.buffer and frame.capture."),
        field("description", &BufferInfo::description, "Content, channels and unit."),
    };
  }
  bool operator==(const BufferInfo&) const = default;
};

struct FrameBuffers {
  std::vector<BufferInfo> buffers;

  static constexpr auto fields() {
    return std::tuple{
        field("buffers", &FrameBuffers::buffers, "The available buffers; `output` is the first."),
    };
  }
  bool operator==(const FrameBuffers&) const = default;
};

struct FrameCapture {
  std::string buffer = "output";
  ImageFormat format = ImageFormat::png;
  std::optional<std::uint32_t> samples;
  bool marks = false;

  static constexpr auto fields() {
    return std::tuple{
        field("buffer", &FrameCapture::buffer, "A name from frame.buffers.")
            .length(1, max_session_name)
            .or_default(),
        field("format", &FrameCapture::format,
              "Format of the file: png and jpeg for viewing, npy and exr for values.")
            .or_default(),
        field("samples", &FrameCapture::samples,
              "Samples per pixel to wait for, at most accumulation.max_samples, 1 without "
              "accumulation; absent: as many as that, and with reference.use when_static those of "
              "the path tracer besides.")
            .range(1, max_samples_per_pixel),
        field("marks", &FrameCapture::marks,
              "Whether the measurements and annotations of the scene are drawn over the image: of "
              "the buffer output only, as png, jpeg or webp.")
            .or_default(),
    };
  }
  bool operator==(const FrameCapture&) const = default;
};

struct CapturedFrame {
  std::string buffer;
  ImageFormat format = ImageFormat::png;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 0;
  std::string data;

  static constexpr auto fields() {
    return std::tuple{
        field("buffer", &CapturedFrame::buffer, "The buffer that was captured."),
        field("format", &CapturedFrame::format, "Format of the file."),
        field("width", &CapturedFrame::width, "Frame width.").unit("pixels"),
        field("height", &CapturedFrame::height, "Frame height.").unit("pixels"),
        field("samples", &CapturedFrame::samples, "Samples accumulated per pixel."),
        field("data", &CapturedFrame::data, "The file as base64 (RFC 4648)."),
    };
  }
  bool operator==(const CapturedFrame&) const = default;
};

}  // namespace heliograph::protocol
