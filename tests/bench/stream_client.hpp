#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace heliograph::bench {

struct ClientOptions {
  std::uint16_t port = 0;
  std::size_t viewers = 1;
  std::size_t stalled = 0;  // more viewers, who say hello and then read nothing
  double seconds = 5.0;
};

/// What one process of viewers saw.
struct ClientReport {
  std::vector<std::uint64_t> frames;      // of each viewer that reads
  std::vector<std::uint64_t> frames_before_stall;
  std::vector<double> overhead_ms;        // render end to first byte, less the encoding
  std::uint64_t bytes = 0;
  std::uint64_t disorder = 0;             // frame numbers or pictures that went backwards
};

/// Watches the server on this machine and acknowledges every frame, without decoding it. Prints
/// "ready" once every viewer has had a picture, then runs for so long.
/// @throws std::runtime_error
ClientReport watch(const ClientOptions& options);

}  // namespace heliograph::bench
