#include "session/inspection/session_annotations.hpp"

#include "session/inspection/session_marks.hpp"

namespace heliograph::session {

using protocol::AnnotationList;
using protocol::Result;

namespace {

template <class Change>
Result<AnnotationList> change_annotations(SessionCore& core, const std::string& by,
                                          const Change& change) {
  return change_marks<protocol::notifications::annotations_changed>(core, &SessionCore::annotations,
                                                                    by, change);
}

}  // namespace

AnnotationList SessionAnnotations::list() const {
  return list_marks(core_, &SessionCore::annotations);
}

AnnotationList SessionAnnotations::list_in(const scene::Scene& scene,
                                           const scene::Pose& pose) const {
  return list_marks_in(core_, &SessionCore::annotations, scene, pose);
}

Result<AnnotationList> SessionAnnotations::add(const protocol::AnnotationAdd& request,
                                               const std::string& by) {
  return change_annotations(core_, by, [&](AnnotationSet& annotations, const ScenePart& part) {
    return annotations.add(part, *core_.scene, request, name_of(by));
  });
}

Result<AnnotationList> SessionAnnotations::edit(const protocol::AnnotationEdit& request,
                                                const std::string& by) {
  return change_annotations(core_, by, [&](AnnotationSet& annotations, const ScenePart& part) {
    return annotations.edit(part, request);
  });
}

Result<AnnotationList> SessionAnnotations::remove(const protocol::AnnotationId& request,
                                                  const std::string& by) {
  return change_annotations(core_, by, [&](AnnotationSet& annotations, const ScenePart& part) {
    return annotations.remove(part, request.id);
  });
}

Result<AnnotationList> SessionAnnotations::clear(const std::string& by) {
  return change_annotations(core_, by, [&](AnnotationSet& annotations, const ScenePart& part) {
    annotations.clear(part);
    return Result<void>();
  });
}

std::string SessionAnnotations::name_of(const std::string& viewer) const {
  return core_.viewers.name_of(viewer).value_or("");
}

}  // namespace heliograph::session
