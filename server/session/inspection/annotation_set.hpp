#pragma once

#include <cstdint>
#include <string>

#include "protocol/messages/annotation_messages.hpp"
#include "protocol/result.hpp"
#include "scene/surface/surface_anchor.hpp"
#include "session/inspection/marks.hpp"

namespace heliograph::session {

/// The annotations of a session, by scene. A refused request changes nothing. Copies share their
/// entries. Not thread safe.
class AnnotationSet {
 public:
  /// `scene` is what `part` names; `author`: of a request that names none.
  protocol::Result<void> add(const ScenePart& part, const scene::Scene& scene,
                             const protocol::AnnotationAdd& request, const std::string& author);
  protocol::Result<void> edit(const ScenePart& part, const protocol::AnnotationEdit& request);
  protocol::Result<void> remove(const ScenePart& part, std::uint32_t id) {
    return marks_.remove(part, id);
  }
  void clear(const ScenePart& part) { marks_.clear(part); }

  /// Where they are in a pose of the scene. What no longer fits a file that was changed is left
  /// out.
  protocol::AnnotationList list(const ScenePart& part, const scene::Scene& scene,
                                const scene::Pose& pose) const;

 private:
  struct Entry {
    ScenePart part;
    std::uint32_t id = 0;
    std::string text;
    std::string author;
    scene::SurfaceAnchor anchor;
    protocol::SurfaceAnchor surface;  // the same, as the protocol has it
  };

  Marks<Entry> marks_{{.article = "an", .name = "annotation", .most = protocol::max_annotations}};
};

}  // namespace heliograph::session
