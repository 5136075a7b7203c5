#include "scene/lights.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::scene {
namespace {

constexpr float half_pi = 1.57079632679f;

// The cone's falloff as a scale and an offset to the cosine, from the extension's text.
void read_cone(const JsonValue& json, shared::Light& light) {
  float inner = 0.0f;
  float outer = half_pi / 2.0f;
  if (const auto spot = json.object("spot")) {
    inner = spot->number("innerConeAngle", inner);
    outer = spot->number("outerConeAngle", outer);
    if (inner < 0.0f || inner >= outer)
      spot->refuse("innerConeAngle", "must be from 0 to below outerConeAngle");
    if (outer > half_pi + 1e-4f) spot->refuse("outerConeAngle", "must be at most pi / 2");
  }
  light.spot_scale = 1.0f / std::max(0.001f, std::cos(inner) - std::cos(outer));
  light.spot_offset = -std::cos(outer) * light.spot_scale;
}

std::uint32_t read_type(const JsonValue& json) {
  const std::string type = json.text("type");
  if (type == "directional") return shared::light_directional;
  if (type == "point") return shared::light_point;
  if (type == "spot") return shared::light_spot;
  json.refuse("type", "is not directional, point or spot");
}

Light read_light(const JsonValue& json) {
  Light light;
  light.name = json.text("name");
  light.device = {};
  light.device.type = read_type(json);
  light.device.direction = {0.0f, 0.0f, -1.0f};
  const float intensity = json.number("intensity", 1.0f);
  if (intensity < 0.0f) json.refuse("intensity", "must not be negative");
  const auto color = json.numbers<3>("color", {1.0f, 1.0f, 1.0f});
  for (int i = 0; i < 3; ++i) {
    if (color[i] < 0.0f) json.refuse("color", "must not be negative");
    light.device.color[i] = color[i] * intensity;
    if (!std::isfinite(light.device.color[i])) json.refuse("intensity", "is too large");
  }
  if (const auto range = json.number("range")) {
    if (*range <= 0.0f) json.refuse("range", "must be more than 0");
    light.device.range = *range;
  }
  if (light.device.type == shared::light_spot) read_cone(json, light.device);
  return light;
}

}  // namespace

std::vector<Light> read_lights(const JsonValue& root) {
  std::vector<Light> lights;
  const auto extension = root.object("extensions", "KHR_lights_punctual");
  if (!extension) return lights;
  for (const JsonValue& json : extension->objects("lights")) lights.push_back(read_light(json));
  return lights;
}

Light place_light(Light light, const std::string& node_name, const glm::mat4& world,
                  float angular_diameter) {
  if (!node_name.empty()) light.name = node_name;
  light.device.position = glm::vec3(world[3]);
  const glm::vec3 direction = -glm::vec3(world[2]);
  const float length = glm::length(direction);
  if (length > 0.0f && std::isfinite(length)) light.device.direction = direction / length;
  if (light.device.type == shared::light_directional) {
    light.angular_diameter = angular_diameter;
    light.device.radius = std::tan(glm::radians(angular_diameter) / 2.0f);
  }
  return light;
}

}  // namespace heliograph::scene
