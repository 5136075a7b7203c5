#pragma once

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
  /// The encoded protocol::FrameDepth, for viewers that asked for it; null: there is none.
  std::shared_ptr<const std::vector<std::uint8_t>> depth;
};

using SharedFrame = std::shared_ptr<const EncodedFrame>;

/// A frame to send to one viewer: its own header bytes, with the depth where the viewer asked for
/// it, and the shared payload.
struct OutgoingFrame {
  std::vector<std::uint8_t> header;
  SharedFrame frame;
};

}  // namespace heliograph::stream
