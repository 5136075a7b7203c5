#pragma once

#include <string>

#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on the annotations of a session's scene. Frames do not depend on them. Thread safe.
/// `by` is the viewer that asks, empty for a caller without a stream.
class SessionAnnotations {
 public:
  explicit SessionAnnotations(SessionCore& core) : core_(core) {}

  protocol::AnnotationList list() const;
  /// Where they are in a pose of the scene; empty if the session shows another scene.
  protocol::AnnotationList list_in(const scene::Scene& scene, const scene::Pose& pose) const;
  protocol::Result<protocol::AnnotationList> add(const protocol::AnnotationAdd& request,
                                                 const std::string& by);
  protocol::Result<protocol::AnnotationList> edit(const protocol::AnnotationEdit& request,
                                                  const std::string& by);
  protocol::Result<protocol::AnnotationList> remove(const protocol::AnnotationId& request,
                                                    const std::string& by);
  protocol::Result<protocol::AnnotationList> clear(const std::string& by);

 private:
  std::string name_of(const std::string& viewer) const;

  SessionCore& core_;
};

}  // namespace heliograph::session
