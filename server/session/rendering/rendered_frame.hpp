#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/messages/frame_depth.hpp"
#include "protocol/messages/frame_header.hpp"
#include "protocol/messages/messages.hpp"
#include "render/api/renderer.hpp"
#include "stream/encoded_frame.hpp"
#include "stream/encoders/image_view.hpp"

namespace heliograph::session {

/// One rendered frame of a session and what it shows.
struct RenderedFrame {
  render::Frame frame;
  protocol::FrameHeader header;  // without what encoding adds
  std::vector<stream::InputEcho> inputs;
  double fps = 0.0;                           // rendered in the last second
  std::uint64_t discontinuities = 0;          // up to this frame
  std::optional<protocol::FrameDepth> depth;  // absent: none, or no viewer wanted it
  bool depth_read = false;
};

inline stream::ImageView image_view(const render::Frame& frame) {
  return {.width = frame.width, .height = frame.height, .rgba = frame.rgba};
}

inline std::vector<protocol::PassTiming> pass_timings(const render::Frame& frame) {
  std::vector<protocol::PassTiming> timings;
  for (const render::PassTime& pass : frame.passes) {
    timings.push_back({.name = pass.name, .kind = pass.kind, .ms = pass.milliseconds});
  }
  return timings;
}

}  // namespace heliograph::session
