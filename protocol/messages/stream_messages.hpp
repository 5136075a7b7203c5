#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/messages/stream_kinds.hpp"

// Messages about the stream of pictures: its form, acknowledgements, timings, single captures.

namespace heliograph::protocol {

struct StreamConfigure {
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  std::optional<std::uint32_t> quality;
  std::optional<double> max_fps;
  std::optional<bool> paused;
  std::optional<StreamCodec> codec;
  std::optional<StillFormat> still;

  static constexpr auto fields() {
    return std::tuple{
        field("width", &StreamConfigure::width, "Picture width.").range(16, 16384).unit("pixels"),
        field("height", &StreamConfigure::height, "Picture height.")
            .range(16, 16384)
            .unit("pixels"),
        field("quality", &StreamConfigure::quality, "Quality on the scale of JPEG, for any codec.")
            .range(1, 100),
        field("max_fps", &StreamConfigure::max_fps, "Most pictures in a second.").range(0.1, 240),
        field("paused", &StreamConfigure::paused, "Whether no pictures are sent."),
        field("codec", &StreamConfigure::codec,
              "Codec while something moves; one that hello agreed on."),
        field("still", &StreamConfigure::still,
              "Format of the final picture: JPEG with all its colour, or PNG without any loss."),
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

  static constexpr auto fields() {
    return std::tuple{
        field("width", &StreamState::width, "Picture width in effect.").unit("pixels"),
        field("height", &StreamState::height, "Picture height in effect.").unit("pixels"),
        field("quality", &StreamState::quality, "Quality asked for; a slow way gets less."),
        field("max_fps", &StreamState::max_fps, "Most pictures in a second."),
        field("paused", &StreamState::paused, "Whether no pictures are sent."),
        field("codec", &StreamState::codec, "Codec while something moves."),
        field("still", &StreamState::still, "Format of the final picture."),
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
        field("frame_seq", &StreamAck::frame_seq, "The frame's number from its header."),
        field("decode_us", &StreamAck::decode_us, "Time the client took to decode it.")
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
              "Least time between two stats.frame notifications; 0: none.")
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
        field("kind", &PassTiming::kind, "Where it ran: a shader or the processor."),
        field("ms", &PassTiming::ms, "How long it took.").unit("milliseconds"),
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
  double round_trip_ms = 0.0;
  double goodput = 0.0;
  std::vector<PassTiming> passes;

  static constexpr auto fields() {
    return std::tuple{
        field("render_id", &StatsFrame::render_id, "The picture these figures are of."),
        field("fps", &StatsFrame::fps, "Pictures rendered in the last second."),
        field("frame_ms", &StatsFrame::frame_ms, "Time to render it.").unit("milliseconds"),
        field("encode_ms", &StatsFrame::encode_ms, "Time to encode it.").unit("milliseconds"),
        field("bytes", &StatsFrame::bytes, "Size of the picture this viewer was sent last.")
            .unit("bytes"),
        field("width", &StatsFrame::width, "Picture width.").unit("pixels"),
        field("height", &StatsFrame::height, "Picture height.").unit("pixels"),
        field("samples", &StatsFrame::samples, "Samples accumulated in each pixel."),
        field("tracer", &StatsFrame::tracer, "What traced the rays."),
        field("state", &StatsFrame::state,
              "Whether the stream follows changes, refines a resting picture, or is done."),
        field("codec", &StatsFrame::codec, "Codec chosen for this viewer while something moves."),
        field("quality", &StatsFrame::quality,
              "Quality chosen for this viewer while something moves."),
        field("scale", &StatsFrame::scale,
              "Size chosen for this viewer while something moves, as a part of the whole size.")
            .range(0, 1),
        field("round_trip_ms", &StatsFrame::round_trip_ms,
              "From sending a picture to this viewer to its acknowledgement.")
            .unit("milliseconds"),
        field("goodput", &StatsFrame::goodput, "What reaches this viewer when it is busy.")
            .unit("bytes per second"),
        field("passes", &StatsFrame::passes, "The frame's passes in their order."),
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
        field("description", &BufferInfo::description, "What it shows."),
    };
  }
  bool operator==(const BufferInfo&) const = default;
};

struct FrameBuffers {
  std::vector<BufferInfo> buffers;

  static constexpr auto fields() {
    return std::tuple{
        field("buffers", &FrameBuffers::buffers, "What can be shown; `output` comes first."),
    };
  }
  bool operator==(const FrameBuffers&) const = default;
};

struct FrameCapture {
  std::string buffer = "output";
  ImageFormat format = ImageFormat::png;
  std::optional<std::uint32_t> samples;

  static constexpr auto fields() {
    return std::tuple{
        field("buffer", &FrameCapture::buffer, "A name that frame.buffers gave.")
            .length(1, 64)
            .or_default(),
        field("format", &FrameCapture::format,
              "Format of the file: png and jpeg for people, npy and exr for values.")
            .or_default(),
        field("samples", &FrameCapture::samples,
              "Samples per pixel to wait for, at most accumulation.max_samples, one without "
              "accumulation; absent: all of them. The answer tells how many there are.")
            .range(1, 65536),
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
        field("width", &CapturedFrame::width, "Picture width.").unit("pixels"),
        field("height", &CapturedFrame::height, "Picture height.").unit("pixels"),
        field("samples", &CapturedFrame::samples, "Samples accumulated in each pixel."),
        field("data", &CapturedFrame::data, "The file as base64 (RFC 4648)."),
    };
  }
  bool operator==(const CapturedFrame&) const = default;
};

}  // namespace heliograph::protocol
