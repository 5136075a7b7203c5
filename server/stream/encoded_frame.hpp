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

/// The newest input of one viewer that a frame shows.
struct InputEcho {
  std::string viewer;
  std::uint32_t seq = 0;
};

/// One encoded frame, shared by all viewers that receive it. The members of the header that differ
/// between viewers (frame_seq, input_seq_echo, queue_us, flags about earlier frames) are filled in
/// when it is taken for a viewer.
struct EncodedFrame {
  protocol::FrameHeader header;
  std::vector<std::uint8_t> payload;
  std::vector<InputEcho> inputs;
  EncodingVariant variant;
  std::optional<VideoPosition> video;  // of a frame that other frames depend on
  bool moving = false;                 // a moving frame, adapted to the link of its viewers
  std::uint64_t cuts = 0;              // number of discontinuities up to this frame
  Clock::time_point encoded_at;
};

using SharedFrame = std::shared_ptr<const EncodedFrame>;

/// A frame to send to one viewer: its own header bytes, the shared payload.
struct OutgoingFrame {
  std::array<std::uint8_t, protocol::frame_header_bytes> header;
  SharedFrame frame;
};

}  // namespace heliograph::stream
