#pragma once

#include <vector>

#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Captures and probes of a session, from commands to the render thread. Thread safe.
class SessionCaptures {
 public:
  explicit SessionCaptures(SessionCore& core) : core_(core) {}

  /// Refused at once without a scene, for an unknown buffer, where marks cannot be drawn, where too
  /// many are pending, and where the file would probably not fit into its answer.
  protocol::Result<void> request_capture(CaptureRequest request);
  protocol::Result<void> request_probe(Probe probe);
  /// Those requested since the last call.
  std::vector<CaptureRequest> take_captures();
  std::vector<Probe> take_probes();

 private:
  protocol::Result<void> accept(CaptureRequest request);

  SessionCore& core_;
};

}  // namespace heliograph::session
