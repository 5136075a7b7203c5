#include "session/state/scene_edits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "protocol/json/suggestions.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::LightInfo;
using protocol::LightType;
using protocol::MaterialInfo;
using protocol::Result;
namespace error = protocol::error;

namespace {

/// "sun", "sun 2" ...; "light 3" where there is no name.
class UniqueNames {
 public:
  explicit UniqueNames(std::string kind) : kind_(std::move(kind)) {}

  std::string next(const std::string& requested) {
    const std::string number = std::to_string(++count_);
    std::string name = requested.empty() ? kind_ + " " + number : requested;
    for (int copy = 2; !taken_.insert(name).second; ++copy) {
      name = (requested.empty() ? kind_ : requested) + " " + std::to_string(copy);
    }
    return name;
  }

 private:
  const std::string kind_;
  int count_ = 0;
  std::set<std::string> taken_;
};

bool is_area(LightType type) {
  return type == LightType::rectangle || type == LightType::disk;
}

LightInfo describe(const scene::Light& light) {
  const shared::Light& device = light.device;
  LightInfo info;
  info.type = static_cast<LightType>(device.type);
  info.intensity = std::max({device.color.x, device.color.y, device.color.z});
  if (info.intensity > 0.0f) info.color = to_protocol(device.color / info.intensity);
  if (info.type != LightType::directional) info.position = to_protocol(device.position);
  if (info.type != LightType::point) info.direction = to_protocol(device.direction);
  switch (info.type) {
    case LightType::directional:
      info.angular_diameter = 2.0f * glm::degrees(std::atan(device.radius));
      break;
    case LightType::rectangle:
      info.width = 2.0f * device.half_width;
      info.height = 2.0f * device.half_height;
      break;
    case LightType::point:
    case LightType::spot:
      info.range = device.range;
      [[fallthrough]];
    case LightType::disk:
      info.radius = device.radius;
      break;
  }
  return info;
}

/// Rotates `light` to another direction; its tangent stays orthogonal.
void rotate(shared::Light& light, glm::vec3 direction) {
  light.direction = glm::normalize(direction);
  glm::vec3 tangent = light.tangent - light.direction * glm::dot(light.direction, light.tangent);
  if (glm::length(tangent) < 1e-3f) {
    const bool along_x = std::abs(light.direction.x) > 0.5f;
    tangent = glm::cross(along_x ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), light.direction);
  }
  light.tangent = glm::normalize(tangent);
}

/// The device's form of `info`; values that it does not have stay.
shared::Light device_form(const LightInfo& info, shared::Light light) {
  light.color = info.enabled ? from_protocol(info.color) * info.intensity : glm::vec3(0.0f);
  if (info.position) light.position = from_protocol(*info.position);
  if (info.direction && from_protocol(*info.direction) != light.direction) {
    rotate(light, from_protocol(*info.direction));
  }
  if (info.range) light.range = *info.range;
  if (info.radius) light.radius = *info.radius;
  if (info.angular_diameter) {
    light.radius = std::tan(0.5f * glm::radians(*info.angular_diameter));
  }
  if (info.width && info.height) {
    light.half_width = 0.5f * *info.width;
    light.half_height = 0.5f * *info.height;
    light.radius = std::sqrt(*info.width * *info.height / 3.14159265359f);
  }
  return light;
}

/// Names of the members of `now` that are not as in `initial`.
template <class Info>
std::vector<std::string> differences(const Info& now, const Info& initial) {
  std::vector<std::string> names;
  const auto compare = [&](const auto& field) {
    if (field.name != "changed" && now.*field.member != initial.*field.member) {
      names.emplace_back(field.name);
    }
  };
  std::apply([&](const auto&... fields) { (compare(fields), ...); }, Info::fields());
  return names;
}

template <class T, class Member>
void apply(const protocol::Change<T>& change, Member& member, const Member& initial) {
  if (change.reset) member = initial;
  if (change.value) member = *change.value;
}

/// A member that only some types of lights have.
template <class T>
Result<void> apply_optional(const protocol::Change<T>& change, std::optional<T>& member,
                            const std::optional<T>& initial, const LightInfo& light,
                            const char* name) {
  if (!change.value && !change.reset) return {};
  if (!initial) {
    return error::invalid(
        std::string("patch.") + name,
        "is not a member of " + std::string(protocol::enum_name(light.type)) + " lights");
  }
  apply(change, member, initial);
  return {};
}

Result<void> apply_shape(const protocol::LightPatch& patch, LightInfo& light,
                         const LightInfo& initial) {
  for (const Result<void>& applied :
       {apply_optional(patch.position, light.position, initial.position, light, "position"),
        apply_optional(patch.direction, light.direction, initial.direction, light, "direction"),
        apply_optional(patch.range, light.range, initial.range, light, "range"),
        apply_optional(patch.radius, light.radius, initial.radius, light, "radius"),
        apply_optional(patch.angular_diameter, light.angular_diameter, initial.angular_diameter,
                       light, "angular_diameter"),
        apply_optional(patch.width, light.width, initial.width, light, "width"),
        apply_optional(patch.height, light.height, initial.height, light, "height")}) {
    if (!applied) return applied;
  }
  return {};
}

Result<LightInfo> patched(LightInfo light, const LightInfo& initial,
                          const protocol::LightPatch& patch) {
  apply(patch.enabled, light.enabled, initial.enabled);
  apply(patch.color, light.color, initial.color);
  apply(patch.intensity, light.intensity, initial.intensity);
  if (const Result<void> changed = apply_shape(patch, light, initial); !changed) {
    return changed.error();
  }
  if (light.direction && glm::length(from_protocol(*light.direction)) < 1e-6f) {
    return error::invalid("patch.direction", "must not be zero");
  }
  if (is_area(light.type) && light.radius && *light.radius <= 0.0f) {
    return error::invalid("patch.radius", "must be greater than 0 for area lights");
  }
  return light;
}

/// The index of the entry of this name, or an error with suggestions.
template <class Info>
Result<std::size_t> find(const std::vector<Info>& list, const std::string& name, const char* kind) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == name) return i;
    names.push_back(list[i].name);
  }
  return error::not_found(
      kind, std::string("the scene has no such ") + kind + protocol::suggestion(name, names));
}

shared::Material device_form(const MaterialInfo& info, shared::Material material) {
  material.base_color = glm::vec4(from_protocol(info.base_color), material.base_color.w);
  material.roughness = info.roughness;
  material.metallic = info.metallic;
  material.emissive = from_protocol(info.emissive);
  material.normal_scale = info.normal_scale;
  material.occlusion_strength = info.occlusion_strength;
  return material;
}

MaterialInfo describe(const shared::Material& material) {
  MaterialInfo info{.name = {},
                    .base_color = to_protocol(glm::vec3(material.base_color)),
                    .roughness = material.roughness,
                    .metallic = material.metallic,
                    .emissive = to_protocol(material.emissive),
                    .normal_scale = material.normal_scale,
                    .occlusion_strength = material.occlusion_strength,
                    .textures = {}};
  const std::array slots{std::pair{"base_color", &material.base_color_texture},
                         std::pair{"metallic_roughness", &material.metallic_roughness_texture},
                         std::pair{"normal", &material.normal_texture},
                         std::pair{"occlusion", &material.occlusion_texture},
                         std::pair{"emissive", &material.emissive_texture}};
  for (const auto& [name, slot] : slots) {
    if (slot->texture != shared::no_texture) info.textures.emplace_back(name);
  }
  return info;
}

/// The lights of the file. Names are unique: a light without one gets its number.
std::vector<LightInfo> describe_lights(const scene::Scene& scene) {
  UniqueNames names("light");
  std::vector<LightInfo> lights;
  for (const scene::Light& light : scene.lights) {
    lights.push_back(describe(light));
    lights.back().name = names.next(light.name);
  }
  return lights;
}

}  // namespace

std::vector<MaterialInfo> describe_materials(const scene::Scene& scene) {
  UniqueNames names("material");
  std::vector<MaterialInfo> materials;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    materials.push_back(describe(scene.materials[i]));
    const bool named = i < scene.material_names.size();
    materials.back().name = names.next(named ? scene.material_names[i] : std::string());
  }
  return materials;
}

SceneEdits::SceneEdits(std::shared_ptr<const scene::Scene> scene)
    : scene_(std::move(scene)),
      lights_(describe_lights(*scene_)),
      materials_(describe_materials(*scene_)) {}

Result<LightInfo> SceneEdits::patch(const protocol::LightsPatch& request) {
  const Result<std::size_t> index = find(lights_, request.light, "light");
  if (!index) return index.error();
  LightInfo initial = describe(scene_->lights[*index]);
  initial.name = lights_[*index].name;
  Result<LightInfo> light = patched(lights_[*index], initial, request.patch);
  if (!light || *light == lights_[*index]) return light;
  light->changed = differences(*light, initial);
  lights_[*index] = *light;
  auto lights = std::make_shared<Lights>();
  for (const scene::Light& it : scene_->lights) lights->push_back(it.device);
  if (device_lights_) *lights = *device_lights_;
  (*lights)[*index] = device_form(*light, scene_->lights[*index].device);
  device_lights_ = std::move(lights);
  return light;
}

Result<MaterialInfo> SceneEdits::patch(const protocol::MaterialsPatch& request) {
  const Result<std::size_t> index = find(materials_, request.material, "material");
  if (!index) return index.error();
  MaterialInfo initial = describe(scene_->materials[*index]);
  initial.name = materials_[*index].name;
  const protocol::MaterialPatch& patch = request.patch;
  MaterialInfo material = materials_[*index];
  apply(patch.base_color, material.base_color, initial.base_color);
  apply(patch.roughness, material.roughness, initial.roughness);
  apply(patch.metallic, material.metallic, initial.metallic);
  apply(patch.emissive, material.emissive, initial.emissive);
  apply(patch.normal_scale, material.normal_scale, initial.normal_scale);
  apply(patch.occlusion_strength, material.occlusion_strength, initial.occlusion_strength);
  if (material == materials_[*index]) return material;
  material.changed = differences(material, initial);
  materials_[*index] = material;
  auto materials =
      std::make_shared<Materials>(device_materials_ ? *device_materials_ : scene_->materials);
  (*materials)[*index] = device_form(material, scene_->materials[*index]);
  device_materials_ = std::move(materials);
  return material;
}

}  // namespace heliograph::session
