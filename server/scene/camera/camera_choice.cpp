#include "scene/camera/camera_choice.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace heliograph::scene {
namespace {

/// The up direction of a camera that looks against `back`.
glm::vec3 upright(const glm::vec3& back) {
  if (std::abs(back.y) < 0.999f) return {0.0f, 1.0f, 0.0f};
  return {0.0f, 0.0f, back.y > 0.0f ? -1.0f : 1.0f};
}

}  // namespace

const Camera* find_camera(const Scene& scene, std::string_view name) {
  const auto named = std::ranges::find(scene.cameras, name, &Camera::name);
  if (named != scene.cameras.end()) return &*named;
  std::size_t number = 0;
  const char* const end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data(), end, number);
  const bool valid = parsed.ec == std::errc() && parsed.ptr == end;
  return valid && number >= 1 && number <= scene.cameras.size() ? &scene.cameras[number - 1]
                                                                : nullptr;
}

glm::vec3 orbit_direction(float azimuth, float elevation) {
  const float around = glm::radians(azimuth), above = glm::radians(elevation);
  return {std::cos(above) * std::sin(around), std::sin(above), std::cos(above) * std::cos(around)};
}

glm::vec3 default_direction() {
  return glm::normalize(glm::vec3(0.55f, 0.35f, 1.0f));
}

std::vector<Camera> fit_cameras(const Bounds& bounds, std::span<const glm::vec3> directions,
                                const Fit& fit) {
  const glm::vec3 center = bounds.empty() ? glm::vec3(0.0f) : bounds.center();
  const glm::vec3 half =
      bounds.empty() ? glm::vec3(1.0f) : 0.5f * (bounds.maximum - bounds.minimum);
  const float slope_y =
      (1.0f - 2.0f * fit.margin) * std::tan(glm::radians(fit.vertical_fov) / 2.0f);
  const float slope_x = slope_y * fit.aspect;
  const float radius = std::max(glm::length(half), 1e-3f);
  float distance = radius * 0.1f;
  std::vector<Camera> cameras;
  for (const glm::vec3& back : directions) {
    const glm::vec3 up = upright(back);
    const glm::vec3 right = glm::normalize(glm::cross(up, back));
    const glm::vec3 upward = glm::cross(back, right);
    // The camera distance at which each corner of the box enters the frustum.
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 offset =
          half * glm::vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const float needed = std::max(std::abs(glm::dot(offset, right)) / slope_x,
                                    std::abs(glm::dot(offset, upward)) / slope_y);
      distance = std::max(distance, needed + glm::dot(offset, back));
    }
    Camera camera;
    camera.name = "fit";
    camera.eye = back;
    camera.up = up;
    cameras.push_back(camera);
  }
  for (Camera& camera : cameras) {
    camera.eye = center + camera.eye * distance;
    camera.target = center;
    camera.vertical_fov = fit.vertical_fov;
    camera.near_plane = std::max(distance, radius) * 1e-3f;
  }
  return cameras;
}

}  // namespace heliograph::scene
