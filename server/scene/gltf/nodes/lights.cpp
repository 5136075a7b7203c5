#include "scene/gltf/nodes/lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {
namespace {

// The cone's falloff as a scale and an offset to the cosine, from the extension's text.
void read_cone(const tinygltf::SpotLight& spot, const std::string& path, shared::Light& light) {
  if (spot.innerConeAngle >= spot.outerConeAngle) {
    refuse_at(path + ".spot", "innerConeAngle", "must be from 0 to below outerConeAngle");
  }
  const auto inner = static_cast<float>(std::cos(spot.innerConeAngle));
  const auto outer = static_cast<float>(std::cos(spot.outerConeAngle));
  light.spot_scale = 1.0f / std::max(0.001f, inner - outer);
  light.spot_offset = -outer * light.spot_scale;
}

shared::Light unplaced(std::uint32_t type) {
  shared::Light light{};
  light.type = type;
  light.direction = {0.0f, 0.0f, -1.0f};
  light.tangent = {1.0f, 0.0f, 0.0f};
  return light;
}

std::uint32_t to_type(const std::string& name) {
  if (name == "directional") return shared::light_directional;
  return name == "point" ? shared::light_point : shared::light_spot;
}

/// `color` times the member `strength` of the object at `path`.
glm::vec3 scaled(const glm::vec3& color, double factor, const std::string& path,
                 const char* strength) {
  const glm::vec3 result = color * static_cast<float>(factor);
  if (!std::isfinite(result.x + result.y + result.z)) refuse_at(path, strength, "is too large");
  return result;
}

Light read_light(const tinygltf::Light& document, std::uint32_t number, const std::string& path) {
  Light light;
  light.name = document.name;
  light.device = unplaced(to_type(document.type));
  glm::vec3 color(1.0f);
  for (std::size_t i = 0; i < document.color.size(); ++i) {
    color[int(i)] = static_cast<float>(document.color[i]);
  }
  light.device.color = scaled(color, document.intensity, path, "intensity");
  light.punctual = PunctualLight{
      .number = number, .color = color, .intensity = static_cast<float>(document.intensity)};
  light.device.range = static_cast<float>(document.range);  // 0: infinite
  if (light.device.type == shared::light_spot) read_cone(document.spot, path, light.device);
  return light;
}

Light read_area_light(const ExtensionValue& value) {
  const bool disk = value.text("shape") == "disk";
  Light light;
  light.device = unplaced(disk ? shared::light_disk : shared::light_rectangle);
  const auto color = value.numbers<3>("color", {1.0f, 1.0f, 1.0f});
  light.device.color = scaled({color[0], color[1], color[2]}, value.number("radiance", 1.0f),
                              value.path(), "radiance");
  if (disk) {
    light.device.radius = *value.number("radius");
  } else {
    light.device.half_width = 0.5f * *value.number("width");
    light.device.half_height = 0.5f * *value.number("height");
    light.device.radius = std::sqrt(4.0f * light.device.half_width * light.device.half_height /
                                    std::numbers::pi_v<float>);
  }
  return light;
}

}  // namespace

NodeLight read_node_light(const tinygltf::Node& node, const std::string& path) {
  NodeLight result;
  if (const auto own = find_extension(node.extensions, "KHR_lights_punctual", path)) {
    result.punctual = own->index("light");
  }
  const ExtensionValue extras(node.extras, path + ".extras");
  if (const auto area = extras.object("areaLight")) result.area = read_area_light(*area);
  if (!result.punctual) return result;
  result.angular_diameter = extras.number("angularDiameterDeg", result.angular_diameter);
  result.radius = extras.number("radius", result.radius);
  return result;
}

std::vector<Light> read_lights(const tinygltf::Model& model) {
  std::vector<Light> lights;
  const std::string path = "extensions.KHR_lights_punctual";
  for (const tinygltf::Light& document : model.lights) {
    const auto number = static_cast<std::uint32_t>(lights.size());
    lights.push_back(read_light(document, number, item_path(path, "lights", number)));
  }
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
