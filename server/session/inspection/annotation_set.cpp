#include "session/inspection/annotation_set.hpp"

#include <algorithm>
#include <utility>

#include "session/inspection/anchors.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

namespace {

protocol::Error unknown_annotation(std::uint32_t id) {
  return error::not_found("id", "the scene has no annotation " + std::to_string(id));
}

}  // namespace

Result<void> AnnotationSet::add(const ScenePart& part, const scene::Scene& scene,
                                const protocol::AnnotationAdd& request, const std::string& author) {
  const auto anchor = to_anchor(scene, request.surface, "surface");
  if (!anchor) return anchor.error();
  Entries entries = *entries_;
  const std::uint32_t id = request.id.value_or(last_id_ + 1);
  const auto place = std::ranges::lower_bound(entries, id, {}, &Entry::id);
  if (place != entries.end() && place->id == id) {
    return error::conflict("id", "there is an annotation " + std::to_string(id));
  }
  if (entries.size() >= protocol::max_annotations) {
    return error::full("the session has no room for more annotations: remove one",
                       std::to_string(protocol::max_annotations) + " of all scenes");
  }
  last_id_ = std::max(last_id_, id);
  entries.insert(place, {.part = part,
                         .id = id,
                         .text = request.text,
                         .author = request.author.value_or(author),
                         .anchor = *anchor,
                         .surface = to_protocol(scene, *anchor)});
  replace(std::move(entries));
  return {};
}

Result<void> AnnotationSet::edit(const ScenePart& part, const protocol::AnnotationEdit& request) {
  Entries entries = *entries_;
  const auto found = std::ranges::find(entries, request.id, &Entry::id);
  if (found == entries.end() || found->part != part) return unknown_annotation(request.id);
  found->text = request.text;
  replace(std::move(entries));
  return {};
}

Result<void> AnnotationSet::remove(const ScenePart& part, std::uint32_t id) {
  Entries entries = *entries_;
  const auto removed = std::erase_if(
      entries, [&](const Entry& entry) { return entry.part == part && entry.id == id; });
  if (removed == 0) return unknown_annotation(id);
  replace(std::move(entries));
  return {};
}

void AnnotationSet::clear(const ScenePart& part) {
  Entries entries = *entries_;
  std::erase_if(entries, [&](const Entry& entry) { return entry.part == part; });
  replace(std::move(entries));
}

void AnnotationSet::replace(Entries entries) {
  entries_ = std::make_shared<const Entries>(std::move(entries));
  ++changes_;
}

protocol::AnnotationList AnnotationSet::list(const ScenePart& part, const scene::Scene& scene,
                                             const scene::Pose& pose) const {
  protocol::AnnotationList list{.scene = part.name, .annotations = {}, .changes = changes_};
  for (const Entry& entry : *entries_) {
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
