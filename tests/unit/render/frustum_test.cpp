#include "render/passes/gbuffer/frustum.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scene/camera/camera.hpp"

namespace heliograph::render {
namespace {

scene::Bounds box(const glm::vec3& center, float half) {
  return {center - half, center + half};
}

scene::Camera down_the_axis() {
  scene::Camera camera;
  camera.eye = {0, 0, 0};
  camera.target = {0, 0, -1};
  camera.vertical_fov = 90.0f;
  camera.near_plane = 0.1f;
  return camera;
}

Frustum frustum(const scene::Camera& camera) {
  return Frustum(scene::projection_matrix(camera, 1.0f) * scene::view_matrix(camera));
}

TEST(Frustum, KeepsVisibleBoxesAndCullsOthers) {
  const Frustum view = frustum(down_the_axis());
  EXPECT_TRUE(view.may_contain(box({0, 0, -5}, 0.5f)));
  EXPECT_TRUE(view.may_contain(box({0, 0, -1e6f}, 0.5f))) << "there is no far plane";
  EXPECT_TRUE(view.may_contain(box({0, 0, 0}, 10.0f))) << "around the eye";
  EXPECT_TRUE(view.may_contain(box({-5.4f, 0, -5}, 0.5f))) << "over the edge";
  EXPECT_FALSE(view.may_contain(box({0, 0, 5}, 0.5f))) << "behind";
  EXPECT_FALSE(view.may_contain(box({-7, 0, -5}, 0.5f))) << "left";
  EXPECT_FALSE(view.may_contain(box({7, 0, -5}, 0.5f))) << "right";
  EXPECT_FALSE(view.may_contain(box({0, 7, -5}, 0.5f))) << "above";
  EXPECT_FALSE(view.may_contain(box({0, -7, -5}, 0.5f))) << "below";
}

TEST(Frustum, OrthographicNearPlaneCulls) {
  scene::Camera camera = down_the_axis();
  camera.orthographic_height = 4.0f;
  camera.far_plane = 100.0f;
  const Frustum view = frustum(camera);
  EXPECT_TRUE(view.may_contain(box({1.5f, 1.5f, -50}, 0.1f)));
  EXPECT_FALSE(view.may_contain(box({2.5f, 0, -50}, 0.1f)));
  EXPECT_FALSE(view.may_contain(box({0, 0, 5}, 0.1f)));
}

TEST(Frustum, NeverCullsBoxWithVisiblePoint) {
  const scene::Camera camera = down_the_axis();
  const glm::mat4 matrix = scene::projection_matrix(camera, 1.0f) * scene::view_matrix(camera);
  const Frustum view(matrix);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> number(-10.0f, 10.0f);
  int visible = 0;
  for (int i = 0; i < 5000; ++i) {
    const glm::vec3 point(number(random), number(random), number(random));
    const glm::vec4 clip = matrix * glm::vec4(point, 1.0f);
    const bool inside =
        std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z <= clip.w;
    if (!inside) continue;
    ++visible;
    scene::Bounds bounds = box(point, 0.0f);
    bounds.include(glm::vec3(number(random), number(random), number(random)));
    EXPECT_TRUE(view.may_contain(bounds));
  }
  EXPECT_GT(visible, 300);
}

}  // namespace
}  // namespace heliograph::render
