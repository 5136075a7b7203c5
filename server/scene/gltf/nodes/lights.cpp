#include "scene/gltf/nodes/lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace heliograph::scene {
namespace {

constexpr float half_pi = 0.5f * std::numbers::pi_v<float>;

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

// "color" times the member `strength`.
glm::vec3 read_color(const JsonValue& json, std::string_view strength) {
  const float factor = json.number(strength, 1.0f);
  if (factor < 0.0f) json.refuse(strength, "must not be negative");
  const auto color = json.numbers<3>("color", {1.0f, 1.0f, 1.0f});
  glm::vec3 result;
  for (int i = 0; i < 3; ++i) {
    if (color[i] < 0.0f) json.refuse("color", "must not be negative");
    result[i] = color[i] * factor;
    if (!std::isfinite(result[i])) json.refuse(strength, "is too large");
  }
  return result;
}

Light read_light(const JsonValue& json) {
  Light light;
  light.name = json.text("name");
  light.device = {};
  light.device.type = read_type(json);
  light.device.direction = {0.0f, 0.0f, -1.0f};
  light.device.tangent = {1.0f, 0.0f, 0.0f};
  light.device.color = read_color(json, "intensity");
  if (const auto range = json.number("range")) {
    if (*range <= 0.0f) json.refuse("range", "must be more than 0");
    light.device.range = *range;
  }
  if (light.device.type == shared::light_spot) read_cone(json, light.device);
  return light;
}

float read_length(const JsonValue& json, std::string_view key) {
  constexpr float max_length = 1e6f;
  const auto length = json.number(key);
  if (!length) json.refuse(key, "is missing");
  if (*length <= 0.0f || *length > max_length)
    json.refuse(key, "must be more than 0 and at most 1e6 metres");
  return *length;
}

Light read_area_light(const JsonValue& json) {
  Light light;
  light.device = {};
  light.device.direction = {0.0f, 0.0f, -1.0f};
  light.device.tangent = {1.0f, 0.0f, 0.0f};
  light.device.color = read_color(json, "radiance");
  const std::string shape = json.text("shape");
  if (shape == "rect") {
    light.device.type = shared::light_rectangle;
    light.device.half_width = 0.5f * read_length(json, "width");
    light.device.half_height = 0.5f * read_length(json, "height");
    light.device.radius = std::sqrt(4.0f * light.device.half_width * light.device.half_height /
                                    std::numbers::pi_v<float>);
  } else if (shape == "disk") {
    light.device.type = shared::light_disk;
    light.device.radius = read_length(json, "radius");
  } else {
    json.refuse("shape", "is not rect or disk");
  }
  return light;
}

}  // namespace

NodeLight read_node_light(const JsonValue& node, std::size_t light_count) {
  NodeLight result;
  if (const auto extension = node.object("extensions", "KHR_lights_punctual")) {
    result.punctual = extension->required_index("light", light_count, "lights");
  }
  // "extras" may be of any type (glTF 3.12): only our own keys are read.
  if (!node.is_object("extras")) return result;
  const auto extras = node.object("extras");
  if (extras->is_object("areaLight")) result.area = read_area_light(*extras->object("areaLight"));
  if (!result.punctual) return result;
  result.angular_diameter = extras->number("angularDiameterDeg", result.angular_diameter);
  if (result.angular_diameter < 0.0f || result.angular_diameter > 90.0f) {
    extras->refuse("angularDiameterDeg", "must be from 0 to 90 degrees");
  }
  result.radius = extras->number("radius", result.radius);
  if (result.radius < 0.0f) extras->refuse("radius", "must not be negative");
  return result;
}

std::vector<Light> read_lights(const JsonValue& root) {
  std::vector<Light> lights;
  const auto extension = root.object("extensions", "KHR_lights_punctual");
  if (!extension) return lights;
  for (const JsonValue& json : extension->objects("lights")) lights.push_back(read_light(json));
  return lights;
}

shared::Light place_light(shared::Light light, const glm::mat4& world) {
  light.position = glm::vec3(world[3]);
  const glm::vec3 direction = -glm::vec3(world[2]);
  const float length = glm::length(direction);
  if (length > 0.0f && std::isfinite(length)) light.direction = direction / length;
  // Orthonormal even where the node's transform is skewed or singular.
  glm::vec3 tangent(world[0]);
  tangent -= light.direction * glm::dot(light.direction, tangent);
  const float width = glm::length(tangent);
  if (width > 1e-6f * glm::length(glm::vec3(world[0])) && std::isfinite(width)) {
    light.tangent = tangent / width;
  } else {
    const bool along_x = std::abs(light.direction.x) > 0.5f;
    const glm::vec3 other = along_x ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    light.tangent = glm::normalize(glm::cross(other, light.direction));
  }
  return light;
}

Light place_light(const std::vector<Light>& punctual, const NodeLight& node,
                  const std::string& node_name, const glm::mat4& world) {
  Light light = node.area ? *node.area : punctual[*node.punctual];
  if (!node_name.empty()) light.name = node_name;
  light.device = place_light(light.device, world);
  if (node.area) return light;
  light.device.radius = node.radius;
  if (light.device.type == shared::light_directional) {
    light.angular_diameter = node.angular_diameter;
    light.device.radius = std::tan(glm::radians(node.angular_diameter) / 2.0f);
  }
  return light;
}

}  // namespace heliograph::scene
