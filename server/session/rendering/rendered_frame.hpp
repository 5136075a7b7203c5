#pragma once

#include <cstdint>
#include <vector>

#include "protocol/messages/frame_header.hpp"
#include "render/api/renderer.hpp"
#include "stream/encoded_frame.hpp"
#include "stream/encoders/image_view.hpp"

namespace heliograph::session {

/// One rendered picture of a session and what it shows.
struct RenderedFrame {
  render::Frame frame;
  protocol::FrameHeader header;  // without what encoding adds
  std::vector<stream::InputEcho> inputs;
  double fps = 0.0;        // rendered in the last second
  std::uint64_t cuts = 0;  // how often the picture jumped up to this one
};

inline stream::ImageView image_view(const render::Frame& frame) {
  return {.width = frame.width, .height = frame.height, .rgba = frame.rgba};
}

}  // namespace heliograph::session
