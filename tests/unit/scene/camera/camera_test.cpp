#include "scene/camera/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scene/camera/camera_choice.hpp"

namespace heliograph::scene {
namespace {

glm::vec3 project(const Camera& camera, float aspect, const glm::vec3& point) {
  const glm::vec4 clip =
      projection_matrix(camera, aspect) * view_matrix(camera) * glm::vec4(point, 1.0f);
  return glm::vec3(clip) / clip.w;
}

Camera looking_down_z() {
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.target = {0, 0, 0};
  camera.vertical_fov = 90.0f;
  camera.near_plane = 0.1f;
  return camera;
}

TEST(CameraMath, WorldUpIsMinusYInClipSpace) {
  const glm::vec3 above = project(looking_down_z(), 2.0f, {0, 5, 0});
  EXPECT_NEAR(above.x, 0.0f, 1e-6f);
  EXPECT_NEAR(above.y, -1.0f, 1e-5f) << "45 degrees up is the upper edge";
  const glm::vec3 right = project(looking_down_z(), 2.0f, {10, 0, 0});
  EXPECT_NEAR(right.x, 1.0f, 1e-5f) << "twice as wide as high";
}

TEST(CameraMath, DepthIsNearOverDistance) {
  const Camera camera = looking_down_z();
  EXPECT_NEAR(project(camera, 1.0f, {0, 0, 4.9f}).z, 1.0f, 1e-4f);
  EXPECT_NEAR(project(camera, 1.0f, {0, 0, 0}).z, 0.1f / 5.0f, 1e-6f);
  const float far_away = project(camera, 1.0f, {0, 0, -1e6f}).z;
  EXPECT_GT(far_away, 0.0f);
  EXPECT_LT(far_away, 1e-6f);
}

TEST(CameraMath, OrthographicDepthIsReversed) {
  Camera camera = looking_down_z();
  camera.orthographic_height = 4.0f;
  camera.near_plane = 1.0f;
  camera.far_plane = 11.0f;
  EXPECT_NEAR(project(camera, 2.0f, {0, 0, 4}).z, 1.0f, 1e-6f);
  EXPECT_NEAR(project(camera, 2.0f, {0, 0, -6}).z, 0.0f, 1e-6f);
  EXPECT_NEAR(project(camera, 2.0f, {0, 2, 0}).y, -1.0f, 1e-6f);
  EXPECT_NEAR(project(camera, 2.0f, {4, 0, 0}).x, 1.0f, 1e-6f);
}

TEST(CameraMath, DegenerateViewDirectionsStayFinite) {
  for (const glm::vec3& target : {glm::vec3(0, 1, 5), glm::vec3(0, -1, 5), glm::vec3(0, 0, 5)}) {
    Camera camera = looking_down_z();
    camera.target = target;
    const glm::mat4 view = view_matrix(camera);
    EXPECT_NEAR(std::abs(glm::determinant(glm::mat3(view))), 1.0f, 1e-4f);
  }
}

TEST(CameraFit, FramesWholeBoxTightly) {
  for (const glm::vec3& size : {glm::vec3(1), glm::vec3(100, 1, 1), glm::vec3(0.01f, 5, 0.01f)}) {
    for (const float aspect : {0.5f, 1.0f, 16.0f / 9.0f}) {
      Bounds bounds;
      bounds.include(glm::vec3(3, -2, 7));
      bounds.include(glm::vec3(3, -2, 7) + size);
      const Camera camera = fit_camera(bounds, 40.0f, aspect);
      float extent = 0.0f;
      for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner(i & 1 ? bounds.maximum.x : bounds.minimum.x,
                               i & 2 ? bounds.maximum.y : bounds.minimum.y,
                               i & 4 ? bounds.maximum.z : bounds.minimum.z);
        const glm::vec3 seen = project(camera, aspect, corner);
        extent = std::max({extent, std::abs(seen.x), std::abs(seen.y)});
        EXPECT_GT(seen.z, 0.0f);
        EXPECT_LT(seen.z, 1.0f);
      }
      EXPECT_LE(extent, 1.0f);
      EXPECT_GT(extent, 0.8f);
    }
  }
}

TEST(CameraFit, CamerasOfATurnHaveOneDistanceAndTheMargin) {
  Bounds bounds;
  bounds.include(glm::vec3(-4, 0, -1));
  bounds.include(glm::vec3(4, 2, 1));
  std::vector<glm::vec3> directions;
  for (int i = 0; i < 8; ++i) directions.push_back(orbit_direction(45.0f * i, 20.0f));
  directions.push_back(orbit_direction(0.0f, 90.0f));
  const float margin = 0.2f;
  const auto cameras = fit_cameras(bounds, directions, {.aspect = 1.5f, .margin = margin});
  float extent = 0.0f;
  for (const Camera& camera : cameras) {
    EXPECT_NEAR(glm::distance(camera.eye, bounds.center()),
                glm::distance(cameras[0].eye, bounds.center()), 1e-4f);
    for (int i = 0; i < 8; ++i) {
      const glm::vec3 corner(i & 1 ? 4 : -4, i & 2 ? 2 : 0, i & 4 ? 1 : -1);
      const glm::vec3 seen = project(camera, 1.5f, corner);
      extent = std::max({extent, std::abs(seen.x), std::abs(seen.y)});
    }
  }
  // Twice the margin of an image that is two units wide.
  EXPECT_NEAR(extent, 1.0f - 2.0f * margin, 1e-3f);
}

TEST(CameraFit, AzimuthTurnsToTheRightAndElevationLifts) {
  EXPECT_LT(glm::distance(orbit_direction(0, 0), glm::vec3(0, 0, 1)), 1e-6f);
  EXPECT_LT(glm::distance(orbit_direction(90, 0), glm::vec3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(orbit_direction(0, 90), glm::vec3(0, 1, 0)), 1e-6f);
}

TEST(CameraFit, EmptySceneHasDefaultCamera) {
  const Camera camera = fit_camera(Bounds{}, 45.0f, 1.5f);
  EXPECT_TRUE(std::isfinite(glm::length(camera.eye)));
  EXPECT_GT(glm::distance(camera.eye, camera.target), 0.5f);
}

}  // namespace
}  // namespace heliograph::scene
