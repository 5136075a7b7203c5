#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "protocol/messages/frame_header.hpp"

namespace heliograph::bench {

struct MovingOptions {
  std::uint16_t port = 0;
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  int quality = 80;
  double max_fps = 240.0;
  double settle = 3.0;    // seconds before the measurement
  double seconds = 10.0;  // of the measurement
  double inputs = 125.0;  // a second, whether frames come or not; 0: each when the last was shown
};

/// A frame that was received.
struct ShownFrame {
  protocol::FrameHeader header;
  std::size_t bytes = 0;
  bool by_device = false;        // a JPEG with restart intervals, as devices make it
  double received_us = 0.0;      // of now_us(), with its last byte
  std::vector<double> input_ms;  // from sending to here, of inputs that it is the first to show
  double wait_ms = 0.0;          // of the newest of those, until rendering began
};

/// Views the session of the server at this port and moves its camera. Calls `begins` when the
/// measurement starts; gives the frames received from then on. @throws std::runtime_error
std::vector<ShownFrame> move_and_watch(const MovingOptions& options,
                                       const std::function<void()>& begins);

}  // namespace heliograph::bench
