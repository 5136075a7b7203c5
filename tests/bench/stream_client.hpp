#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace heliograph::bench {

/// What every viewer is shown.
inline constexpr std::uint32_t shown_width = 1280;
inline constexpr std::uint32_t shown_height = 720;
inline constexpr int shown_quality = 80;

struct ClientOptions {
  std::uint16_t port = 0;
  std::size_t viewers = 1;
  std::size_t stalled = 0;  // more viewers, who say hello and then read nothing
  double settle = 0.5;      // seconds before anything is counted
  double seconds = 5.0;     // for which it is counted
};

/// What one process of viewers saw.
struct ClientReport {
  std::vector<std::uint64_t> frames;  // of each viewer that reads
  std::vector<double> overhead_ms;    // of each frame: render end to first byte, less the encoding
  std::uint64_t bytes = 0;            // everything that came, headers too
  std::uint64_t disorder = 0;         // frame numbers or pictures that went backwards
  std::uint64_t adapted = 0;          // frames of less than the quality or size that was asked for
};

/// Watches the server on this machine and acknowledges every frame, without decoding it. `tell` is
/// called when every viewer has had a picture, and with true when things have settled and counting
/// starts. @throws std::runtime_error
ClientReport watch(const ClientOptions& options, const std::function<void(bool)>& tell);

}  // namespace heliograph::bench
