#include "scene/camera/camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/camera/camera_choice.hpp"

namespace heliograph::scene {

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

Camera fit_camera(const Bounds& bounds, float vertical_fov, float aspect) {
  const glm::vec3 back = default_direction();
  return fit_cameras(bounds, {&back, 1}, {.vertical_fov = vertical_fov, .aspect = aspect}).front();
}

}  // namespace heliograph::scene
