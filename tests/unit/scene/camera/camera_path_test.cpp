#include "scene/camera/camera_path.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace heliograph::scene {
namespace {

Camera key(const glm::vec3& eye, const glm::vec3& target = glm::vec3(0.0f), float fov = 45.0f) {
  return {.eye = eye, .target = target, .vertical_fov = fov};
}

void expect_near(const glm::vec3& found, const glm::vec3& expected, const char* what = "") {
  EXPECT_NEAR(glm::distance(found, expected), 0.0f, 1e-4f)
      << what << " " << found.x << ", " << found.y << ", " << found.z;
}

TEST(CameraPath, PassesThroughItsKeys) {
  const std::vector keys = {key({0, 0, 4}), key({4, 0, 0}), key({0, 0, -2}, {0, 1, 0}, 30.0f)};
  for (const bool smooth : {true, false}) {
    const PathForm form{.smooth = smooth};
    expect_near(camera_on_path(keys, form, 0.0f).eye, {0, 0, 4});
    expect_near(camera_on_path(keys, form, 0.5f).eye, {4, 0, 0});
    const Camera last = camera_on_path(keys, form, 1.0f);
    expect_near(last.eye, {0, 0, -2});
    expect_near(last.target, {0, 1, 0});
    EXPECT_FLOAT_EQ(last.vertical_fov, 30.0f);
  }
}

TEST(CameraPath, TurnsAboutTheTargetInsteadOfCuttingAcross) {
  const std::vector keys = {key({0, 0, 4}), key({4, 0, 0})};
  const Camera middle = camera_on_path(keys, {.smooth = false}, 0.5f);
  expect_near(middle.eye, {2 * std::sqrt(2.0f), 0, 2 * std::sqrt(2.0f)});
  const std::vector opposite = {key({0, 0, 4}), key({0, 0, -1})};
  const Camera around = camera_on_path(opposite, {.smooth = false}, 0.5f);
  EXPECT_NEAR(glm::length(around.eye), 2.0f, 1e-4f) << "the geometric mean of both distances";
  EXPECT_NEAR(around.eye.z, 0.0f, 1e-4f);
}

// The page plays paths by its own code: web_client/tests/view/camera_path.test.ts has the same
// figures.
TEST(CameraPath, IsThatOfThePage) {
  const std::vector keys = {key({0, 1, 4}), key({3, 2, 1}, {0.5f, 0, 0}), key({-1, 1, -3}),
                            key({-4, 3, 0}, {0, 0.5f, 0}, 60.0f)};
  const Camera open = camera_on_path(keys, {}, 0.3f);
  expect_near(open.eye, {2.52075f, 1.85003f, 2.19914f}, "open");
  const Camera closed = camera_on_path(keys, {.closed = true}, 0.9f);
  expect_near(closed.eye, {-2.08645f, 1.94042f, 3.58504f}, "closed");
  EXPECT_NEAR(closed.vertical_fov, 51.36f, 0.01f);
}

TEST(CameraPath, BeginsAndEndsSlowlyWhereItIsSmooth) {
  const std::vector keys = {key({0, 0, 4}, {0, 0, 0}), key({8, 0, 4}, {8, 0, 0})};
  const float smooth = camera_on_path(keys, {}, 0.1f).target.x;
  const float linear = camera_on_path(keys, {.smooth = false}, 0.1f).target.x;
  EXPECT_NEAR(linear, 0.8f, 1e-5f);
  EXPECT_LT(smooth, 0.3f);
}

TEST(CameraPath, LeadsBackWhereItIsClosed) {
  const std::vector keys = {key({0, 0, 4}), key({4, 0, 0}), key({0, 0, -4})};
  expect_near(camera_on_path(keys, {.closed = true}, 0.0f).eye, {0, 0, 4});
  expect_near(camera_on_path(keys, {.closed = true}, 1.0f).eye, {0, 0, 4});
  expect_near(camera_on_path(keys, {.closed = true}, 1.0f / 3.0f).eye, {4, 0, 0});
}

}  // namespace
}  // namespace heliograph::scene
