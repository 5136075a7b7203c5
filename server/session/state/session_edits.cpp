#include <utility>

#include "protocol/json/jsonrpc.hpp"
#include "session/state/session.hpp"

// What a session changes in its scene: lights, materials, environment.

namespace heliograph::session {

using protocol::Result;
namespace error = protocol::error;

Result<protocol::LightList> Session::lights() const {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  return protocol::LightList{.lights = edits_.lights(), .rev = state_.rev};
}

Result<protocol::LightState> Session::patch_light(const protocol::LightsPatch& request,
                                                  const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  Result<protocol::LightInfo> light = edits_.patch(request);
  if (!light) return light.error();
  if (state_.lights != edits_.device_lights()) {
    state_.lights = edits_.device_lights();
    changed();
    const protocol::LightsChanged message{.light = *light, .rev = state_.rev, .by = by};
    viewers_.send_others(
        by, protocol::make_notification<protocol::notifications::lights_changed>(message), {});
  }
  return protocol::LightState{.light = *std::move(light), .rev = state_.rev};
}

Result<protocol::MaterialList> Session::materials() const {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  return protocol::MaterialList{.materials = edits_.materials(), .rev = state_.rev};
}

Result<protocol::MaterialState> Session::patch_material(const protocol::MaterialsPatch& request,
                                                        const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there.error();
  Result<protocol::MaterialInfo> material = edits_.patch(request);
  if (!material) return material.error();
  if (state_.materials != edits_.device_materials()) {
    state_.materials = edits_.device_materials();
    changed();
    const protocol::MaterialsChanged message{.material = *material, .rev = state_.rev, .by = by};
    viewers_.send_others(
        by, protocol::make_notification<protocol::notifications::materials_changed>(message), {});
  }
  return protocol::MaterialState{.material = *std::move(material), .rev = state_.rev};
}

protocol::EnvironmentState Session::environment() const {
  const std::lock_guard lock(mutex_);
  return {.environments = {},
          .current = environment_name_,
          .rotation = state_.settings.environment.rotation,
          .intensity = state_.settings.environment.intensity,
          .rev = state_.rev};
}

Result<void> Session::set_environment(std::optional<std::string> name,
                                      std::shared_ptr<const render::LitEnvironment> environment,
                                      const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> there = require_scene(); !there) return there;
  if (name == environment_name_ && environment == state_.environment) return {};
  state_.environment = std::move(environment);
  environment_name_ = std::move(name);
  changed();
  const protocol::EnvironmentChanged message{
      .current = environment_name_, .rev = state_.rev, .by = by};
  viewers_.send_others(
      by, protocol::make_notification<protocol::notifications::environment_changed>(message),
      "environment.changed");
  return {};
}

void Session::unload(const std::string& by) {
  const std::lock_guard lock(mutex_);
  if (!scene_) return;
  const protocol::SceneUnloaded message{.name = scene_info_.name, .by = by};
  scene_ = nullptr;
  scene_info_ = {};
  edits_ = {};
  environment_name_.reset();
  camera_name_.reset();
  state_.resources = nullptr;
  state_.lights = nullptr;
  state_.materials = nullptr;
  state_.environment = nullptr;
  state_.animation = {};
  changed();
  viewers_.send_others(
      by, protocol::make_notification<protocol::notifications::scene_unloaded>(message), {});
}

Result<void> Session::request_probe(Probe probe) {
  {
    const std::lock_guard lock(mutex_);
    if (const Result<void> there = require_scene(); !there) return there;
    if (probes_.size() >= options_.limits.max_captures) {
      return error::full("too many picks and inspections are pending",
                         std::to_string(options_.limits.max_captures));
    }
    probe.place = next_place();
    probes_.push_back(std::move(probe));
  }
  changed_->notify();
  return {};
}

std::vector<Probe> Session::take_probes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(probes_, {});
}

}  // namespace heliograph::session
