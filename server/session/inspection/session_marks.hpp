#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "scene/animation/explosion.hpp"
#include "session/state/session_core.hpp"

// What commands on marks of any kind have in common: `marks` is a member of SessionCore.

namespace heliograph::session {

/// The list of those of the session's scene, where they are now; empty without one.
template <class Set>
auto list_marks(const SessionCore& core, Set SessionCore::*marks) {
  using List = decltype((core.*marks).list(core.part(), *core.scene, scene::Pose()));
  std::unique_lock lock(core.mutex);
  if (!core.scene) return List();
  const Set copy = core.*marks;  // shares its entries
  const std::shared_ptr<const scene::Scene> scene = core.scene;
  const ScenePart part = core.part();
  const std::string clip = core.timeline.clock().clip;
  const double seconds = core.clip_seconds();
  const float explode = core.settings.view.explode;
  lock.unlock();  // a pose of many nodes takes milliseconds
  return copy.list(part, *scene,
                   scene::shown_pose(*scene, scene::find_clip(*scene, clip), seconds, explode));
}

/// Those of a scene that the session shows, where they are in a pose of it; empty if it shows
/// another.
template <class Set>
auto list_marks_in(const SessionCore& core, Set SessionCore::*marks, const scene::Scene& scene,
                   const scene::Pose& pose) {
  using List = decltype((core.*marks).list(core.part(), scene, pose));
  std::unique_lock lock(core.mutex);
  if (core.scene.get() != &scene) return List();
  const Set copy = core.*marks;  // shares its entries
  const ScenePart part = core.part();
  lock.unlock();
  return copy.list(part, scene, pose);
}

/// Changes them by `change(marks, part)`, under the lock, and tells viewers but `by`.
/// @return their list
template <class Notification, class Set, class Change>
auto change_marks(SessionCore& core, Set SessionCore::*marks, const std::string& by,
                  const Change& change) -> protocol::Result<decltype(Notification::Params::list)> {
  const std::lock_guard lock(core.mutex);
  if (const protocol::Result<void> loaded = core.require_scene(); !loaded) return loaded.error();
  const ScenePart part = core.part();
  if (const protocol::Result<void> done = change(core.*marks, part); !done) return done.error();
  core.lead();
  const scene::Clip* const clip = scene::find_clip(*core.scene, core.timeline.clock().clip);
  const scene::Pose pose =
      scene::shown_pose(*core.scene, clip, core.clip_seconds(), core.settings.view.explode);
  const typename Notification::Params message{.list = (core.*marks).list(part, *core.scene, pose),
                                              .by = by};
  core.notify_others_latest<Notification>(by, message);
  return message.list;
}

}  // namespace heliograph::session
