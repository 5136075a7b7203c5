#include "scene/gltf/nodes/cameras.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace heliograph::scene {
namespace {

float required_number(const JsonValue& json, std::string_view key) {
  const auto value = json.number(key);
  if (!value) json.refuse(key, "is missing");
  return *value;
}

void read_perspective(const JsonValue& json, Camera& camera) {
  const float vertical_fov = required_number(json, "yfov");
  if (vertical_fov <= 0.0f || vertical_fov >= 3.14159265f)
    json.refuse("yfov", "must be between 0 and pi");
  camera.vertical_fov = glm::degrees(vertical_fov);
  camera.near_plane = required_number(json, "znear");
  if (camera.near_plane <= 0.0f) json.refuse("znear", "must be more than 0");
  const auto far_plane = json.number("zfar");
  if (far_plane && *far_plane <= camera.near_plane) {
    json.refuse("zfar", "must be more than znear");
  }
  if (json.number("aspectRatio", 1.0f) <= 0.0f) json.refuse("aspectRatio", "must be more than 0");
}

void read_orthographic(const JsonValue& json, Camera& camera) {
  if (required_number(json, "xmag") == 0.0f) json.refuse("xmag", "must not be 0");
  camera.orthographic_height = 2.0f * std::abs(required_number(json, "ymag"));
  if (camera.orthographic_height == 0.0f || !std::isfinite(camera.orthographic_height)) {
    json.refuse("ymag", "must not be 0, nor too large");
  }
  camera.near_plane = required_number(json, "znear");
  camera.far_plane = required_number(json, "zfar");
  if (camera.near_plane < 0.0f) json.refuse("znear", "must not be negative");
  if (camera.far_plane <= camera.near_plane) json.refuse("zfar", "must be more than znear");
}

glm::vec3 normalized_or(const glm::vec3& vector, const glm::vec3& fallback) {
  const float length = glm::length(vector);
  return length > 0.0f && std::isfinite(length) ? vector / length : fallback;
}

/// Orbit distance of a camera in metres: to the scene's center from outside; short from inside, so
/// that orbiting stays within a room.
float focus_distance(const Camera& camera, const glm::vec3& forward, const Bounds& bounds) {
  if (bounds.empty()) return 1.0f;
  const bool inside = glm::all(glm::greaterThan(camera.eye, bounds.minimum)) &&
                      glm::all(glm::lessThan(camera.eye, bounds.maximum));
  if (inside) return 0.1f * bounds.radius();
  return std::max(glm::dot(bounds.center() - camera.eye, forward), 0.1f);
}

}  // namespace

std::vector<Camera> read_cameras(const JsonValue& root) {
  std::vector<Camera> cameras;
  for (const JsonValue& json : root.objects("cameras")) {
    Camera& camera = cameras.emplace_back();
    camera.name = json.text("name");
    const std::string type = json.text("type");
    if (type != "perspective" && type != "orthographic") {
      json.refuse("type", "is not perspective or orthographic");
    }
    const auto properties = json.object(type);
    if (!properties) json.refuse(type, "is missing");
    (type == "perspective" ? read_perspective : read_orthographic)(*properties, camera);
  }
  return cameras;
}

void name_apart(std::vector<Camera>& cameras) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::string& name = cameras[i].name;
    if (name.empty()) name = "camera " + std::to_string(i + 1);
    const std::string requested = name;
    for (int number = 2; !names.insert(name).second; ++number) {
      name = requested + " " + std::to_string(number);
    }
  }
}

Camera place_camera(Camera camera, const std::string& node_name, const glm::mat4& world,
                    const Bounds& bounds) {
  if (!node_name.empty()) camera.name = node_name;
  const glm::vec3 forward = normalized_or(-glm::vec3(world[2]), {0.0f, 0.0f, -1.0f});
  camera.eye = glm::vec3(world[3]);
  camera.up = normalized_or(glm::vec3(world[1]), {0.0f, 1.0f, 0.0f});
  camera.target = camera.eye + forward * focus_distance(camera, forward, bounds);
  return camera;
}

}  // namespace heliograph::scene
