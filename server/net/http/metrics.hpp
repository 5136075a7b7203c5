#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "session/session_host.hpp"

namespace heliograph::net {

/// Counters of all connections. Used by the network thread only.
struct Traffic {
  std::size_t connections = 0;  // open now
  std::uint64_t connections_refused = 0;
  std::map<int, std::uint64_t> responses;       // by HTTP status; 101 are viewers
  std::uint64_t calls = 0;                      // JSON-RPC messages of viewers
  std::uint64_t calls_refused = 0;              // by the rate limit
  std::uint64_t slow_viewers_disconnected = 0;  // disconnected
};

struct MetricsInput {
  const session::SessionHost& host;
  const Traffic& traffic;
  std::chrono::steady_clock::time_point started;
  bool draining = false;
};

/// The server's metrics in the Prometheus text format, version 0.0.4.
std::string metrics_text(const MetricsInput& input);

}  // namespace heliograph::net
