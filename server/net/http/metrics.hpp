#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "session/session_host.hpp"

namespace heliograph::net {

/// What the connections count. Used by the network thread only.
struct Traffic {
  std::size_t connections = 0;  // open now
  std::uint64_t connections_refused = 0;
  std::map<int, std::uint64_t> responses;  // by HTTP status; 101 are viewers
  std::uint64_t calls = 0;                 // JSON-RPC messages of viewers
  std::uint64_t calls_refused = 0;         // for coming too fast
  std::uint64_t viewers_let_go = 0;        // for not reading what they are sent
};

struct MetricsInput {
  const session::SessionHost& host;
  const Traffic& traffic;
  std::chrono::steady_clock::time_point started;
  bool draining = false;
};

/// The server's figures in the Prometheus text format, version 0.0.4.
std::string metrics_text(const MetricsInput& input);

}  // namespace heliograph::net
