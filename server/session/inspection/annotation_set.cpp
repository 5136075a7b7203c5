#include "session/inspection/annotation_set.hpp"

#include "session/inspection/anchors.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::Result;

Result<void> AnnotationSet::add(const ScenePart& part, const scene::Scene& scene,
                                const protocol::AnnotationAdd& request, const std::string& author) {
  const auto anchor = to_anchor(scene, request.surface, "surface");
  if (!anchor) return anchor.error();
  return marks_.add({.part = part,
                     .id = request.id.value_or(marks_.next_id()),
                     .text = request.text,
                     .author = request.author.value_or(author),
                     .anchor = *anchor,
                     .surface = to_protocol(scene, *anchor)});
}

Result<void> AnnotationSet::edit(const ScenePart& part, const protocol::AnnotationEdit& request) {
  return marks_.edit(part, request.id, [&](Entry& entry) { entry.text = request.text; });
}

protocol::AnnotationList AnnotationSet::list(const ScenePart& part, const scene::Scene& scene,
                                             const scene::Pose& pose) const {
  protocol::AnnotationList list{.scene = part.name, .annotations = {}, .changes = marks_.changes()};
  for (const Entry& entry : marks_.entries()) {
    if (entry.part != part || !scene::has_triangle(scene, entry.anchor)) continue;
    const scene::SurfaceLocation location = scene::locate(scene, pose, entry.anchor);
    list.annotations.push_back({.id = entry.id,
                                .text = entry.text,
                                .author = entry.author,
                                .surface = entry.surface,
                                .position = to_protocol(location.position),
                                .normal = to_protocol(location.normal)});
  }
  return list;
}

}  // namespace heliograph::session
