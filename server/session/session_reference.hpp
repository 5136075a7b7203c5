#pragma once

#include <string>

#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on the path traced reference of a session. Thread safe. `by` is the viewer that asks,
/// empty for a caller without a stream.
class SessionReference {
 public:
  explicit SessionReference(SessionCore& core) : core_(core) {}

  protocol::Result<protocol::ReferenceState> start(const protocol::ReferenceStart& request,
                                                   const std::string& by);
  /// Restores the settings that `start` changed.
  protocol::Result<protocol::ReferenceState> stop(const std::string& by);
  protocol::ReferenceState state() const;
  /// For the render thread: the newest frame, of this version of the session's state.
  void report_frame(std::uint64_t version, std::uint32_t samples, bool converged);

 private:
  protocol::ReferenceState state_locked() const;

  SessionCore& core_;
};

}  // namespace heliograph::session
