#include "session/edits/light_edits.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "protocol/limits.hpp"
#include "scene/animation/tracks.hpp"
#include "session/edits/edited_parts.hpp"
#include "session/edits/light_form.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::LightInfo;
using protocol::LightType;
using protocol::Result;
namespace error = protocol::error;

namespace {

constexpr float new_irradiance = 3.0f;  // lux, at the middle of the scene
constexpr float new_size = 0.25f;       // half the side of an area light, in radii of the scene
constexpr float pi = 3.14159265359f;

/// What makes a new light of this type as bright as others in the middle of a scene of `radius`.
float new_intensity(LightType type, float radius) {
  switch (type) {
    case LightType::directional:
      return new_irradiance;
    case LightType::rectangle:
      return new_irradiance / (4.0f * new_size * new_size);
    case LightType::disk:
      return new_irradiance / (pi * new_size * new_size);
    case LightType::point:
    case LightType::spot:
      break;
  }
  return new_irradiance * radius * radius;
}

std::string name_of_type(LightType type) {
  return std::string(protocol::enum_name(type));
}

}  // namespace

LightEdits::LightEdits(std::shared_ptr<const scene::Scene> scene) : scene_(std::move(scene)) {
  UniqueNames names("light");
  for (const scene::Light& light : scene_->lights) {
    LightInfo info = describe(light);
    info.name = names.next(light.name);
    lights_.push_back({.initial = info, .now = info, .device = light.device});
  }
}

std::vector<LightInfo> LightEdits::list() const {
  std::vector<LightInfo> list;
  for (const Light& light : lights_) {
    if (!light.removed) list.push_back(light.now);
  }
  return list;
}

LightEdits::Light* LightEdits::find(const std::string& name) {
  const auto found =
      std::ranges::find_if(lights_, [&](const Light& light) { return light.now.name == name; });
  return found == lights_.end() ? nullptr : &*found;
}

protocol::Error LightEdits::unknown(const std::string& name) const {
  std::vector<std::string_view> names;
  for (const Light& light : lights_) {
    if (!light.removed) names.push_back(light.now.name);
  }
  return no_such_part("light", name, names);
}

Result<LightInfo> LightEdits::patch(const protocol::LightsPatch& request) {
  Light* const light = find(request.light);
  if (!light || light->removed) return unknown(request.light);
  Result<LightInfo> changed = patched(light->now, light->initial, request.patch);
  if (!changed || *changed == light->now) return changed;
  changed->changed = differences(*changed, light->initial);
  light->now = *changed;
  update_device();
  return changed;
}

Result<LightInfo> LightEdits::add(const protocol::LightAdd& request) {
  if (request.name) {
    if (Light* const known = find(*request.name)) return bring_back(*known, request);
  }
  const std::size_t added = lights_.size() - scene_->lights.size();
  if (added >= protocol::max_added_lights) {
    return error::full("the session has added so many lights",
                       std::to_string(protocol::max_added_lights));
  }
  Light light = make_light(request.type);
  light.initial.name = request.name.value_or(name_of_type(request.type) + " light");
  for (int copy = 2; !request.name && find(light.initial.name); ++copy) {
    light.initial.name = name_of_type(request.type) + " light " + std::to_string(copy);
  }
  light.initial.added = true;
  if (request.patch) {
    Result<LightInfo> changed = patched(light.initial, light.initial, *request.patch);
    if (!changed) return changed;
    light.device = device_form(*changed, light.initial, light.device);
    light.initial = *std::move(changed);
  }
  light.now = light.initial;
  lights_.push_back(light);
  update_device();
  return light.now;
}

/// A removed light of the file, with the changes of the request.
Result<LightInfo> LightEdits::bring_back(Light& light, const protocol::LightAdd& request) {
  if (!light.removed) return error::conflict("name", "is the name of another light");
  if (light.initial.type != request.type) {
    return error::conflict("type", "differs from that of the file's light of this name");
  }
  Result<LightInfo> changed =
      patched(light.initial, light.initial, request.patch.value_or(protocol::LightPatch()));
  if (!changed) return changed;
  changed->changed = differences(*changed, light.initial);
  light.now = *changed;
  light.removed = false;
  update_device();
  return changed;
}

Result<void> LightEdits::remove(const std::string& name) {
  Light* const light = find(name);
  if (!light || light->removed) return unknown(name);
  if (light->now.added) {
    lights_.erase(lights_.begin() + (light - lights_.data()));
  } else {
    light->removed = true;
  }
  update_device();
  return {};
}

/// In the middle of the scene, from above, bright enough to be seen.
LightEdits::Light LightEdits::make_light(LightType type) const {
  const scene::Bounds& bounds = scene_->bounds;
  const float radius = bounds.radius();
  scene::Light light;
  light.device = {};
  light.device.type = static_cast<std::uint32_t>(type);
  light.device.position = bounds.empty() ? glm::vec3(0.0f) : bounds.center();
  light.device.position.y += radius;
  light.device.direction = {0.0f, -1.0f, 0.0f};
  light.device.tangent = {1.0f, 0.0f, 0.0f};
  light.device.color = glm::vec3(new_intensity(type, radius));
  light.device.radius = 0.01f * radius;
  if (type == LightType::directional) light.device.radius = std::tan(glm::radians(0.265f));
  if (type == LightType::disk) light.device.radius = new_size * radius;
  if (type == LightType::rectangle) {
    light.device.half_width = light.device.half_height = new_size * radius;
    light.device.radius = 2.0f * new_size * radius / std::sqrt(pi);
  }
  if (type == LightType::spot) {
    const float outer = std::cos(glm::radians(40.0f));
    light.device.spot_scale = 1.0f / (std::cos(glm::radians(30.0f)) - outer);
    light.device.spot_offset = -outer * light.device.spot_scale;
  }
  const LightInfo info = describe(light);
  return {.initial = info, .now = info, .device = light.device};
}

void LightEdits::describe_edits(protocol::EditDocument& document) const {
  for (const Light& light : lights_) {
    const LightInfo& now = light.now;
    if (light.removed) {
      document.removed_lights.push_back(now.name);
    } else if (now.added) {
      document.added_lights.push_back({now.type, now.name, whole_patch(now)});
    } else if (!now.changed.empty()) {
      document.lights.push_back({now.name, patch_of(now, now.changed)});
    }
  }
}

Result<void> LightEdits::apply(const protocol::EditDocument& document) {
  const auto entry = [](const char* list, std::size_t index) {
    return std::string("edits.") + list + "[" + std::to_string(index) + "]";
  };
  for (std::size_t i = 0; i < document.lights.size(); ++i) {
    const auto changed = patch(document.lights[i]);
    if (!changed) return below(changed.error(), entry("lights", i));
  }
  for (std::size_t i = 0; i < document.removed_lights.size(); ++i) {
    const auto removed = remove(document.removed_lights[i]);
    if (!removed) {
      return error::make(removed.error().code, entry("removed_lights", i), removed.error().reason);
    }
  }
  for (std::size_t i = 0; i < document.added_lights.size(); ++i) {
    const auto added = add(document.added_lights[i]);
    if (!added) return below(added.error(), entry("added_lights", i));
  }
  return {};
}

std::vector<scene::LightChange> LightEdits::changes() const {
  std::vector<scene::LightChange> changes;
  for (const Light& light : lights_) {
    LightInfo shining = light.now;
    shining.enabled = true;
    const bool same = light.now.changed.empty() && light.now.enabled;
    changes.push_back(
        {.name = light.now.name,
         .device = same ? light.device : device_form(shining, light.initial, light.device),
         .off = !light.now.enabled,
         .removed = light.removed});
  }
  return changes;
}

void LightEdits::update_device() {
  const bool edited = std::ranges::any_of(lights_, [](const Light& light) {
    return light.removed || light.now.added || !light.now.changed.empty();
  });
  if (!edited && !device_) return;
  auto lights = std::make_shared<Lights>();
  for (const Light& light : lights_) {
    const bool same = light.now.changed.empty();
    lights->push_back(same ? light.device : device_form(light.now, light.initial, light.device));
    if (light.removed) lights->back().color = glm::vec3(0.0f);
  }
  device_ = std::move(lights);
  if (scene::has_tracks(*scene_)) share_list();
}

void LightEdits::share_list() {
  std::vector<LightInfo> list;
  for (std::size_t i = 0; i < scene_->lights.size(); ++i) {
    list.push_back(lights_[i].now);
    if (lights_[i].removed) list.back().enabled = false;
  }
  shared_list_ = std::make_shared<const std::vector<LightInfo>>(std::move(list));
}

}  // namespace heliograph::session
