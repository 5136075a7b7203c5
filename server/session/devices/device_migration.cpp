#include "session/devices/device_migration.hpp"

namespace heliograph::session {

std::shared_ptr<const render::SceneResources> DeviceMigration::operator()(
    const std::shared_ptr<const render::SceneResources>& object) {
  if (is_done(object)) return object;
  if (auto found = find(*render::scene_of(*object))) return found;
  auto renewed = engine_.renew(*object);
  add(renewed);
  return renewed;
}

/// The engine shares those of the same content.
std::shared_ptr<const render::LitEnvironment> DeviceMigration::operator()(
    const std::shared_ptr<const render::LitEnvironment>& object) {
  return is_done(object) ? object : engine_.renew(*object);
}

void DeviceMigration::add(const std::shared_ptr<const render::SceneResources>& resources) {
  const std::lock_guard lock(mutex_);
  std::erase_if(scenes_, [](const auto& weak) { return weak.expired(); });
  scenes_.push_back(resources);
}

/// Every load makes a scene of its own, with one environment.
std::shared_ptr<const render::SceneResources> DeviceMigration::find(const scene::Scene& scene) {
  const std::lock_guard lock(mutex_);
  for (const auto& weak : scenes_) {
    auto here = weak.lock();
    if (here && render::scene_of(*here).get() == &scene && engine_.owns(*here)) return here;
  }
  return nullptr;
}

}  // namespace heliograph::session
