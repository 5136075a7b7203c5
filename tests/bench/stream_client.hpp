#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace heliograph::bench {

/// Size and quality of the stream.
inline constexpr std::uint32_t shown_width = 1280;
inline constexpr std::uint32_t shown_height = 720;
inline constexpr int shown_quality = 80;

struct ClientOptions {
  std::uint16_t port = 0;
  std::size_t viewers = 1;
  std::size_t stalled = 0;  // additional viewers that read nothing after hello
  double settle = 0.5;      // seconds before the measurement
  double seconds = 5.0;     // seconds of measurement
};

/// Measurements of one process of viewers.
struct ClientReport {
  std::vector<std::uint64_t> frames;  // of each viewer that reads
  std::vector<double> overhead_ms;    // of each frame: render end to first byte, less the encoding
  std::uint64_t bytes = 0;            // all bytes received, headers included
  std::uint64_t disorder = 0;         // frames out of order
  std::uint64_t adapted = 0;          // frames below the requested quality or size
};

/// Views the local server's stream and acknowledges every frame without decoding it. Calls
/// `tell(false)` when every viewer has a frame, and `tell(true)` when the measurement starts.
/// @throws std::runtime_error
ClientReport watch(const ClientOptions& options, const std::function<void(bool)>& tell);

}  // namespace heliograph::bench
