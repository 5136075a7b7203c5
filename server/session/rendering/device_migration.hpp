#pragma once

#include <map>
#include <memory>

#include "render/api/renderer.hpp"

namespace heliograph::session {

/// Moves what was on a lost device to the present one. What several sessions share stays shared
/// as long as they use the same migration.
class DeviceMigration {
 public:
  explicit DeviceMigration(render::Engine& engine) : engine_(engine) {}

  /// `object` itself where nothing needs to be done.
  template <class Object>
  std::shared_ptr<const Object> operator()(const std::shared_ptr<const Object>& object) {
    if (!object || engine_.owns(*object)) return object;
    std::shared_ptr<const void>& migrated = migrated_[object.get()];
    if (!migrated) migrated = engine_.renew(*object);
    return std::static_pointer_cast<const Object>(migrated);
  }

 private:
  render::Engine& engine_;
  std::map<const void*, std::shared_ptr<const void>> migrated_;
};

}  // namespace heliograph::session
