#include "scene/gltf/nodes/cameras.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "scene/gltf/schema/place.hpp"

namespace heliograph::scene {
namespace {

void read_perspective(const tinygltf::PerspectiveCamera& document, const std::string& path,
                      Camera& camera) {
  camera.vertical_fov = glm::degrees(static_cast<float>(document.yfov));
  camera.near_plane = static_cast<float>(document.znear);
  // tinygltf's 0 stands for an infinite projection.
  if (document.zfar != 0.0 && document.zfar <= document.znear) {
    refuse_at(path, "zfar", "must be more than znear");
  }
}

void read_orthographic(const tinygltf::OrthographicCamera& document, const std::string& path,
                       Camera& camera) {
  if (document.xmag == 0.0) refuse_at(path, "xmag", "must not be 0");
  camera.orthographic_height = 2.0f * std::abs(static_cast<float>(document.ymag));
  if (camera.orthographic_height == 0.0f || !std::isfinite(camera.orthographic_height)) {
    refuse_at(path, "ymag", "must not be 0, nor too large");
  }
  camera.near_plane = static_cast<float>(document.znear);
  camera.far_plane = static_cast<float>(document.zfar);
  if (camera.far_plane <= camera.near_plane) refuse_at(path, "zfar", "must be more than znear");
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

std::vector<Camera> read_cameras(const tinygltf::Model& model) {
  std::vector<Camera> cameras;
  for (const tinygltf::Camera& document : model.cameras) {
    const std::string path = item_path("", "cameras", cameras.size()) + "." + document.type;
    Camera& camera = cameras.emplace_back();
    camera.name = document.name;
    camera.number = static_cast<std::uint32_t>(cameras.size() - 1);
    if (document.type == "perspective") {
      read_perspective(document.perspective, path, camera);
    } else {
      read_orthographic(document.orthographic, path, camera);
    }
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
