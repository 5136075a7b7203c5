#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "protocol/messages/frame_messages.hpp"
#include "protocol/result.hpp"

namespace heliograph::session {

/// Frames to render in lockstep.
struct StepRequest {
  std::uint32_t frames = 1;
  double dt = 0.0;  // seconds before each of them
  /// Who asked; empty for one without a stream. Who leaves the session wants them no more.
  std::string viewer;
  /// Called once, on any thread.
  std::function<void(protocol::Result<protocol::StepState>)> done;
};

}  // namespace heliograph::session
