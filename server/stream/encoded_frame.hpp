#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/frame_header.hpp"
#include "stream/pacing/encoding_variant.hpp"

namespace heliograph::stream {

using Clock = std::chrono::steady_clock;

/// The newest input of one viewer that a picture shows.
struct InputEcho {
  std::string viewer;
  std::uint32_t seq = 0;
};

/// One encoded picture, made once and shared by all who see it. The members of the header that
/// differ between viewers (frame_seq, input_seq_echo, queue_us, flags about what came before) are
/// filled in when a viewer takes it.
struct EncodedFrame {
  protocol::FrameHeader header;
  std::vector<std::uint8_t> payload;
  std::vector<InputEcho> inputs;
  Form form;
  std::optional<VideoPosition> video;  // of frames that need each other
  bool moving = false;                 // one of many, made to fit the way to its viewers
  std::uint64_t cuts = 0;              // how often the picture jumped up to this one
  Clock::time_point encoded_at;
};

using SharedFrame = std::shared_ptr<const EncodedFrame>;

/// A frame on its way to one viewer: its own header bytes, the shared payload.
struct OutgoingFrame {
  std::array<std::uint8_t, protocol::frame_header_bytes> header;
  SharedFrame frame;
};

}  // namespace heliograph::stream
