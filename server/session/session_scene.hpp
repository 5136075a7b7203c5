#pragma once

#include <memory>
#include <optional>
#include <string>

#include "session/library/loaded_scene.hpp"
#include "session/state/session_core.hpp"

namespace heliograph::session {

/// Commands on the scene of a session, its lights, materials and environment. Thread safe. `by` is
/// the viewer that asks, empty for a caller without a stream.
class SessionScene {
 public:
  explicit SessionScene(SessionCore& core) : core_(core) {}

  protocol::Result<protocol::SceneInfo> info() const;
  void show(LoadedScene scene, const std::string& by);
  void unload(const std::string& by);

  protocol::Result<protocol::LightList> lights() const;
  protocol::Result<protocol::LightState> patch_light(const protocol::LightsPatch& request,
                                                     const std::string& by);
  protocol::Result<protocol::MaterialList> materials() const;
  protocol::Result<protocol::MaterialState> patch_material(const protocol::MaterialsPatch& request,
                                                           const std::string& by);
  /// What is in effect, without the environments of the catalogue.
  protocol::EnvironmentState environment() const;
  /// `environment` is the one called `name`; both empty: the scene's own.
  protocol::Result<void> set_environment(std::optional<std::string> name,
                                         std::shared_ptr<const render::LitEnvironment> environment,
                                         const std::string& by);

 private:
  SessionCore& core_;
};

}  // namespace heliograph::session
