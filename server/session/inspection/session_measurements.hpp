#pragma once

#include <string>

#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on what is measured in a session's scene. Frames do not depend on it. Thread safe. `by`
/// is the viewer that asks, empty for a caller without a stream.
class SessionMeasurements {
 public:
  explicit SessionMeasurements(SessionCore& core) : core_(core) {}

  protocol::MeasurementList list() const;
  /// Where they are in a pose of the scene; empty if the session shows another scene.
  protocol::MeasurementList list_in(const scene::Scene& scene, const scene::Pose& pose) const;
  protocol::Result<protocol::MeasurementList> add(const protocol::MeasurementAdd& request,
                                                  const std::string& by);
  protocol::Result<protocol::MeasurementList> remove(const protocol::MeasurementId& request,
                                                     const std::string& by);
  protocol::Result<protocol::MeasurementList> clear(const std::string& by);
  protocol::Result<protocol::MeasurementList> set_unit(const protocol::MeasurementUnit& request,
                                                       const std::string& by);

 private:
  SessionCore& core_;
};

}  // namespace heliograph::session
