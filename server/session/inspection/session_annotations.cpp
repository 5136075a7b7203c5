#include "session/inspection/session_annotations.hpp"

#include "session/inspection/anchors.hpp"

namespace heliograph::session {

using protocol::AnnotationList;
using protocol::Result;

AnnotationList SessionAnnotations::list() const {
  std::unique_lock lock(core_.mutex);
  if (!core_.scene) return {};
  const AnnotationSet annotations = core_.annotations;
  const std::shared_ptr<const scene::Scene> scene = core_.scene;
  const ScenePart part = core_.part();
  const std::string clip = core_.timeline.clock().clip;
  const double seconds = core_.clip_seconds();
  lock.unlock();  // a pose of many nodes takes milliseconds
  return annotations.list(part, *scene, pose_at(*scene, clip, seconds));
}

template <class Change>
Result<AnnotationList> SessionAnnotations::change(const std::string& by, const Change& change) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const ScenePart part = core_.part();
  if (const Result<void> done = change(part); !done) return done.error();
  core_.lead();
  const scene::Pose pose = pose_at(*core_.scene, core_.timeline.clock().clip, core_.clip_seconds());
  const protocol::AnnotationsChanged message{
      .list = core_.annotations.list(part, *core_.scene, pose), .by = by};
  core_.notify_others_latest<protocol::notifications::annotations_changed>(by, message);
  return message.list;
}

Result<AnnotationList> SessionAnnotations::add(const protocol::AnnotationAdd& request,
                                               const std::string& by) {
  return change(by, [&](const ScenePart& part) {
    return core_.annotations.add(part, *core_.scene, request, name_of(by));
  });
}

Result<AnnotationList> SessionAnnotations::edit(const protocol::AnnotationEdit& request,
                                                const std::string& by) {
  return change(by, [&](const ScenePart& part) { return core_.annotations.edit(part, request); });
}

Result<AnnotationList> SessionAnnotations::remove(const protocol::AnnotationId& request,
                                                  const std::string& by) {
  return change(by,
                [&](const ScenePart& part) { return core_.annotations.remove(part, request.id); });
}

Result<AnnotationList> SessionAnnotations::clear(const std::string& by) {
  return change(by, [&](const ScenePart& part) {
    core_.annotations.clear(part);
    return Result<void>();
  });
}

std::string SessionAnnotations::name_of(const std::string& viewer) const {
  for (const protocol::ViewerInfo& one : core_.viewers.participants(viewer)) {
    if (one.you) return one.name.value_or("");
  }
  return {};
}

}  // namespace heliograph::session
