#include "session/edits/light_form.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "session/edits/color_temperature.hpp"
#include "session/edits/edited_parts.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

using protocol::LightInfo;
using protocol::LightType;
using protocol::Result;
namespace error = protocol::error;

namespace {

bool is_area(LightType type) {
  return type == LightType::rectangle || type == LightType::disk;
}

/// KHR_lights_punctual: cos(outer) = -offset / scale, cos(inner) = cos(outer) + 1 / scale.
void describe_cone(const shared::Light& device, LightInfo& info) {
  const float outer = -device.spot_offset / device.spot_scale;
  const auto degrees = [](float cosine) {
    return glm::degrees(std::acos(std::clamp(cosine, -1.0f, 1.0f)));
  };
  info.outer_cone = degrees(outer);
  info.inner_cone = degrees(outer + 1.0f / device.spot_scale);
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

/// A temperature gives the colour, and another colour ends it.
void apply_color(const protocol::LightPatch& patch, LightInfo& light, const LightInfo& initial) {
  const protocol::Change<float>& temperature = patch.temperature;
  if (patch.color.value || patch.color.reset || temperature.reset) {
    const bool other = patch.color.value.has_value();
    light.color = other ? *patch.color.value : initial.color;
    light.temperature = other ? std::nullopt : initial.temperature;
  }
  if (!temperature.value) return;
  light.temperature = *temperature.value;
  light.color = to_protocol(black_body_color(*temperature.value));
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
  apply_change(change, member, initial);
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
        apply_optional(patch.height, light.height, initial.height, light, "height"),
        apply_optional(patch.inner_cone, light.inner_cone, initial.inner_cone, light, "inner_cone"),
        apply_optional(patch.outer_cone, light.outer_cone, initial.outer_cone, light,
                       "outer_cone")}) {
    if (!applied) return applied;
  }
  return {};
}

}  // namespace

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
    case LightType::spot:
      describe_cone(device, info);
      [[fallthrough]];
    case LightType::point:
      info.range = device.range;
      [[fallthrough]];
    case LightType::disk:
      info.radius = device.radius;
      break;
  }
  return info;
}

shared::Light device_form(const LightInfo& info, const LightInfo& initial, shared::Light light) {
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
  if (info.outer_cone != initial.outer_cone || info.inner_cone != initial.inner_cone) {
    const float outer = std::cos(glm::radians(*info.outer_cone));
    const float inner = std::cos(glm::radians(*info.inner_cone));
    light.spot_scale = 1.0f / std::max(0.001f, inner - outer);
    light.spot_offset = -outer * light.spot_scale;
  }
  return light;
}

Result<LightInfo> patched(LightInfo light, const LightInfo& initial,
                          const protocol::LightPatch& patch) {
  apply_change(patch.enabled, light.enabled, initial.enabled);
  apply_change(patch.intensity, light.intensity, initial.intensity);
  apply_color(patch, light, initial);
  if (const Result<void> changed = apply_shape(patch, light, initial); !changed) {
    return changed.error();
  }
  if (light.direction && glm::length(from_protocol(*light.direction)) < 1e-6f) {
    return error::invalid("patch.direction", "must not be zero");
  }
  if (is_area(light.type) && light.radius && *light.radius <= 0.0f) {
    return error::invalid("patch.radius", "must be greater than 0 for area lights");
  }
  if (light.outer_cone && *light.inner_cone >= *light.outer_cone) {
    return error::invalid(patch.outer_cone.value ? "patch.outer_cone" : "patch.inner_cone",
                          "inner_cone must be below outer_cone");
  }
  return light;
}

protocol::LightPatch patch_of(const LightInfo& light, const std::vector<std::string>& members) {
  protocol::LightPatch patch;
  const auto take = [&](const char* name, auto& change, const auto& value) {
    if (std::ranges::find(members, name) != members.end()) change.value = value;
  };
  take("enabled", patch.enabled, light.enabled);
  take("intensity", patch.intensity, light.intensity);
  if (light.temperature) take("temperature", patch.temperature, light.temperature);
  if (!light.temperature) take("color", patch.color, light.color);
  take("position", patch.position, light.position);
  take("direction", patch.direction, light.direction);
  take("range", patch.range, light.range);
  take("radius", patch.radius, light.radius);
  take("angular_diameter", patch.angular_diameter, light.angular_diameter);
  take("width", patch.width, light.width);
  take("height", patch.height, light.height);
  take("inner_cone", patch.inner_cone, light.inner_cone);
  take("outer_cone", patch.outer_cone, light.outer_cone);
  return patch;
}

protocol::LightPatch whole_patch(const LightInfo& light) {
  std::vector<std::string> members;
  std::apply([&](const auto&... fields) { (members.emplace_back(fields.name), ...); },
             LightInfo::fields());
  return patch_of(light, members);
}

}  // namespace heliograph::session
