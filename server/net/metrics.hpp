#pragma once

#include <chrono>
#include <string>

#include "session/session_host.hpp"

namespace heliograph::net {

/// The server's figures in the Prometheus text format, version 0.0.4.
std::string metrics_text(const session::SessionHost& host,
                         std::chrono::steady_clock::time_point started);

}  // namespace heliograph::net
