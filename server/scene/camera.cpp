#include "scene/camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/camera_fit.hpp"

namespace heliograph::scene {
namespace {

/// The up direction of a camera that looks against `back`.
glm::vec3 upright(const glm::vec3& back) {
  if (std::abs(back.y) < 0.999f) return {0.0f, 1.0f, 0.0f};
  return {0.0f, 0.0f, back.y > 0.0f ? -1.0f : 1.0f};
}

}  // namespace

glm::mat4 view_matrix(const Camera& camera) {
  glm::vec3 forward = camera.target - camera.eye;
  const float distance = glm::length(forward);
  forward = distance > 0.0f ? forward / distance : glm::vec3(0.0f, 0.0f, -1.0f);
  glm::vec3 up = camera.up;
  if (!(glm::length(glm::cross(forward, up)) > 1e-5f * glm::length(up)) ||
      glm::length(up) == 0.0f) {
    up = std::abs(forward.y) < 0.9f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(0.0f, 0.0f, -1.0f);
  }
  return glm::lookAtRH(camera.eye, camera.eye + forward, up);
}

glm::mat4 projection_matrix(const Camera& camera, float aspect) {
  glm::mat4 matrix(0.0f);
  if (camera.orthographic_height > 0.0f) {
    const float depth = camera.far_plane - camera.near_plane;
    matrix[0][0] = 2.0f / (camera.orthographic_height * aspect);
    matrix[1][1] = -2.0f / camera.orthographic_height;
    matrix[2][2] = 1.0f / depth;
    matrix[3][2] = camera.far_plane / depth;
    matrix[3][3] = 1.0f;
    return matrix;
  }
  const float focal_length = 1.0f / std::tan(glm::radians(camera.vertical_fov) / 2.0f);
  matrix[0][0] = focal_length / aspect;
  matrix[1][1] = -focal_length;
  matrix[2][3] = -1.0f;
  matrix[3][2] = camera.near_plane;
  return matrix;
}

bool same_view(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.up == b.up &&
         a.vertical_fov == b.vertical_fov && a.orthographic_height == b.orthographic_height &&
         a.near_plane == b.near_plane && a.far_plane == b.far_plane;
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

Camera fit_camera(const Bounds& bounds, float vertical_fov, float aspect) {
  const glm::vec3 back = default_direction();
  return fit_cameras(bounds, {&back, 1}, {.vertical_fov = vertical_fov, .aspect = aspect}).front();
}

}  // namespace heliograph::scene
