#include "session/session_scene.hpp"

#include <utility>

#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::Result;

Result<protocol::SceneInfo> SessionScene::info() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return core_.scene_info;
}

void SessionScene::show(LoadedScene scene, const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  core_.scene = scene.scene;
  core_.scene_info = describe_scene(scene);
  core_.edits = SceneEdits(core_.scene);
  core_.nodes = NodeState(core_.scene);
  core_.resources = std::move(scene.resources);
  core_.timeline.reset_clock();
  core_.camera.reset(*core_.scene, core_.aspect());
  core_.changed();
  core_.notify_others<protocol::notifications::scene_changed>(
      by, {.scene = core_.scene_info, .by = by});
}

void SessionScene::unload(const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (!core_.scene) return;
  const protocol::SceneUnloaded message{.name = core_.scene_info.name, .by = by};
  core_.scene = nullptr;
  core_.scene_info = {};
  core_.edits = {};
  core_.nodes = {};
  core_.resources = nullptr;
  core_.environment = nullptr;
  core_.environment_name.reset();
  core_.timeline.reset_clock();
  core_.camera.clear_name();
  core_.changed();
  core_.notify_others<protocol::notifications::scene_unloaded>(by, message);
}

Result<protocol::LightList> SessionScene::lights() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return protocol::LightList{.lights = core_.edits.lights(), .rev = core_.rev};
}

Result<protocol::LightState> SessionScene::patch_light(const protocol::LightsPatch& request,
                                                       const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const auto before = core_.edits.device_lights();
  Result<protocol::LightInfo> light = core_.edits.patch(request);
  if (!light) return light.error();
  if (core_.edits.device_lights() != before) {
    core_.changed();
    core_.notify_others<protocol::notifications::lights_changed>(
        by, {.light = *light, .rev = core_.rev, .by = by});
  }
  return protocol::LightState{.light = *std::move(light), .rev = core_.rev};
}

Result<protocol::MaterialList> SessionScene::materials() const {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  return protocol::MaterialList{.materials = core_.edits.materials(), .rev = core_.rev};
}

Result<protocol::MaterialState> SessionScene::patch_material(
    const protocol::MaterialsPatch& request, const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded.error();
  const auto before = core_.edits.device_materials();
  Result<protocol::MaterialInfo> material = core_.edits.patch(request);
  if (!material) return material.error();
  if (core_.edits.device_materials() != before) {
    core_.changed();
    core_.notify_others<protocol::notifications::materials_changed>(
        by, {.material = *material, .rev = core_.rev, .by = by});
  }
  return protocol::MaterialState{.material = *std::move(material), .rev = core_.rev};
}

protocol::EnvironmentState SessionScene::environment() const {
  const std::lock_guard lock(core_.mutex);
  return {.environments = {},
          .current = core_.environment_name,
          .rotation = core_.settings.environment.rotation,
          .intensity = core_.settings.environment.intensity,
          .rev = core_.rev};
}

Result<void> SessionScene::set_environment(
    std::optional<std::string> name, std::shared_ptr<const render::LitEnvironment> environment,
    const std::string& by) {
  const std::lock_guard lock(core_.mutex);
  if (const Result<void> loaded = core_.require_scene(); !loaded) return loaded;
  if (name == core_.environment_name && environment == core_.environment) return {};
  core_.environment = std::move(environment);
  core_.environment_name = std::move(name);
  core_.changed();
  core_.notify_others_latest<protocol::notifications::environment_changed>(
      by, {.current = core_.environment_name, .rev = core_.rev, .by = by});
  return {};
}

}  // namespace heliograph::session
