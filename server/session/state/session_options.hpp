#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "protocol/settings/settings.hpp"

namespace heliograph::session {

struct SessionLimits {
  std::uint32_t max_width = 3840;
  std::uint32_t max_height = 2160;
  std::size_t max_viewers = 32;
  std::size_t max_captures = 32;         // unanswered; as many probes and as many steps beside them
  std::chrono::seconds idle_timeout{0};  // zero: the server's; the shorter of both counts
};

struct SessionOptions {
  std::string name = "main";
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  protocol::Settings settings;
  SessionLimits limits;
  std::string follows;  // the session whose scene, settings and time it has; empty: its own
  /// The index of the device that renders it; empty: where it is placed when it is opened.
  std::optional<std::size_t> device;
  /// No scene will be loaded at the start: the first frame does not wait for one.
  bool starts_empty = false;
};

}  // namespace heliograph::session
