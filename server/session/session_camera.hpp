#pragma once

#include <string>

#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on the camera of a session. Thread safe. `by` is the viewer that asks, empty for a
/// caller without a stream.
class SessionCamera {
 public:
  explicit SessionCamera(SessionCore& core) : core_(core) {}

  protocol::Result<protocol::Camera> get() const;
  /// How often it was moved.
  std::uint64_t moves() const;
  protocol::Result<protocol::Camera> set(const protocol::CameraSet& request, const std::string& by);
  protocol::Result<protocol::Camera> orbit(const protocol::CameraOrbit& request,
                                           const std::string& by);
  /// Shows the whole scene, or some of its nodes.
  protocol::Result<protocol::Camera> fit(const protocol::CameraFit& request, const std::string& by);

 private:
  protocol::Camera publish(const std::string& by);

  SessionCore& core_;
};

}  // namespace heliograph::session
