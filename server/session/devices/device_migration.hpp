#pragma once

#include <list>
#include <memory>
#include <mutex>

#include "render/api/engine.hpp"

namespace heliograph::session {

/// Brings what is on a lost device, or on another one, to the present device of one engine. What
/// several sessions share stays shared. Thread safe.
class DeviceMigration {
 public:
  explicit DeviceMigration(render::Engine& engine) : engine_(engine) {}

  /// Whether it is there already, or null.
  template <class Object>
  bool is_done(const std::shared_ptr<const Object>& object) const {
    return !object || engine_.owns(*object);
  }
  /// `object` itself where nothing needs to be done. @throws render::DeviceLost
  std::shared_ptr<const render::SceneResources> operator()(
      const std::shared_ptr<const render::SceneResources>& object);
  std::shared_ptr<const render::LitEnvironment> operator()(
      const std::shared_ptr<const render::LitEnvironment>& object);
  /// What was uploaded to this device without it.
  void add(const std::shared_ptr<const render::SceneResources>& resources);

 private:
  std::shared_ptr<const render::SceneResources> find(const scene::Scene& scene);

  render::Engine& engine_;
  std::mutex mutex_;
  std::list<std::weak_ptr<const render::SceneResources>> scenes_;  // on the device
};

}  // namespace heliograph::session
