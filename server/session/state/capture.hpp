#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/kinds.hpp"
#include "protocol/result.hpp"

namespace heliograph::session {

/// One buffer as a file.
struct Capture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t samples = 0;
  std::vector<std::uint8_t> file;
};

struct CaptureRequest {
  std::string buffer = "output";
  protocol::ImageFormat format = protocol::ImageFormat::png;
  /// Samples to wait for; absent: all that accumulation gives.
  std::optional<std::uint32_t> samples;
  /// Who asked; empty for one without a stream. Who leaves the session wants it no more.
  std::string viewer;
  /// In lockstep: its place among the steps, given by the session.
  std::optional<std::uint64_t> place;
  /// Called once, on any thread.
  std::function<void(protocol::Result<Capture>)> done;
  /// Counts among those that wait for as long as it is held.
  std::shared_ptr<void> seat;
};

}  // namespace heliograph::session
