#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "session/state/camera_state.hpp"
#include "session/state/capture_queue.hpp"
#include "session/state/reference_mode.hpp"

namespace heliograph::session {
namespace {

using protocol::ErrorCode;
using protocol::Vec3;

scene::Scene unit_box() {
  scene::Scene scene;
  scene.bounds.include(glm::vec3(-1.0f));
  scene.bounds.include(glm::vec3(1.0f));
  scene::Camera camera;
  camera.name = "front";
  camera.eye = {0.0f, 0.0f, 3.0f};
  scene.cameras = {camera};
  return scene;
}

class CameraStateTest : public testing::Test {
 protected:
  CameraStateTest() { camera_.reset(scene_, 1.0f); }

  const scene::Scene scene_ = unit_box();
  CameraState camera_;
};

TEST_F(CameraStateTest, OrbitKeepsTheDistanceAndClampsTheElevation) {
  ASSERT_TRUE(camera_.orbit({.pitch = 500.0f}, ""));
  EXPECT_NEAR(glm::length(camera_.camera().eye), 3.0f, 1e-5f);
  EXPECT_NEAR(camera_.camera().eye.y, 3.0f * std::sin(glm::radians(89.0f)), 1e-5f);
  EXPECT_EQ(camera_.message(1, 1).name, std::nullopt) << "it is not the scene's camera any more";
}

TEST_F(CameraStateTest, ARefusedOrbitNamesTheMemberAndChangesNothing) {
  const glm::vec3 before = camera_.camera().eye;
  const auto refused = camera_.orbit({.yaw = 10.0f, .distance = 1e30f, .seq = 4}, "v1");
  EXPECT_EQ(refused.error().path, "distance");
  EXPECT_EQ(camera_.camera().eye, before);
  EXPECT_TRUE(camera_.inputs().empty());
}

TEST_F(CameraStateTest, JumpsAreDiscontinuitiesAndMovesAreNot) {
  const auto before = camera_.discontinuities();
  ASSERT_TRUE(camera_.set({.eye = Vec3{0, 0, 4}}, scene_, ""));
  ASSERT_TRUE(camera_.orbit({.yaw = 10.0f}, ""));
  EXPECT_EQ(camera_.discontinuities(), before);
  ASSERT_TRUE(camera_.set({.name = "front"}, scene_, ""));
  camera_.fit(scene_.bounds, 1.0f);
  camera_.reset(scene_, 1.0f);
  EXPECT_EQ(camera_.discontinuities(), before + 3);
}

TEST_F(CameraStateTest, ACopyIsADiscontinuityHoweverOftenTheOtherHasJumped) {
  for (int jumps = 0; jumps < 3; ++jumps) {
    CameraState other;
    for (int i = 0; i < jumps; ++i) other.fit(scene_.bounds, 1.0f);
    const auto before = camera_.discontinuities();
    camera_.copy_from(other);
    EXPECT_GT(camera_.discontinuities(), before) << jumps;
  }
}

bool is_settable(const scene::Camera& camera) {
  const glm::vec3 limit(protocol::max_coordinate);
  return glm::all(glm::lessThanEqual(glm::abs(camera.eye), limit)) &&
         glm::all(glm::lessThanEqual(glm::abs(camera.target), limit)) &&
         camera.vertical_fov >= protocol::min_field_of_view &&
         camera.vertical_fov <= protocol::max_field_of_view;
}

TEST(FittedCamera, IsWithinTheRangeOfCameraSet) {
  for (const auto& [from, to] : {std::pair{glm::vec3(-1e11f), glm::vec3(1e11f)},
                                 std::pair{glm::vec3(5e11f), glm::vec3(6e11f)},
                                 std::pair{glm::vec3(-6e11f), glm::vec3(-5e11f)},
                                 std::pair{glm::vec3(9.99e8f), glm::vec3(1e9f)}}) {
    scene::Scene scene;
    scene.bounds.include(from);
    scene.bounds.include(to);
    CameraState camera;
    camera.reset(scene, 1.5f);
    EXPECT_TRUE(is_settable(camera.camera())) << from.x;
    camera.fit(scene.bounds, 1.5f);
    EXPECT_TRUE(is_settable(camera.camera())) << from.x;
    const protocol::Camera message = camera.message(1, 1);
    EXPECT_TRUE(camera.set({.eye = message.eye, .target = message.target}, scene, "")) << from.x;
  }
}

TEST(FittedCamera, BringsTheFieldOfViewOfASceneCameraIntoRange) {
  scene::Scene scene = unit_box();
  for (const auto& [of_scene, fitted] : {std::pair{0.2f, 1.0f}, std::pair{175.0f, 170.0f}}) {
    scene.cameras[0].vertical_fov = of_scene;
    CameraState camera;
    camera.reset(scene, 1.0f);
    camera.fit(scene.bounds, 1.0f);
    EXPECT_FLOAT_EQ(camera.camera().vertical_fov, fitted);
    EXPECT_TRUE(is_settable(camera.camera()));
  }
}

TEST(CaptureQueue, ACaptureIsPendingUntilItIsAnswered) {
  CaptureQueue queue(1);
  queue.add(CaptureRequest{});
  EXPECT_EQ(queue.check_capture_capacity().error().code, ErrorCode::full);
  auto taken = queue.take_captures();
  EXPECT_EQ(queue.check_capture_capacity().error().code, ErrorCode::full);
  taken.clear();
  EXPECT_TRUE(queue.check_capture_capacity());
}

TEST(CaptureQueue, GivesTheFirstTicketOfCapturesAndProbes) {
  CaptureQueue queue(4);
  EXPECT_EQ(queue.first_ticket(), std::nullopt);
  queue.add(CaptureRequest{});
  EXPECT_EQ(queue.first_ticket(), std::nullopt) << "not in lockstep";
  queue.add(CaptureRequest{.ticket = 7});
  queue.add(Probe{.ticket = 5, .read = {}, .fail = {}});
  EXPECT_EQ(queue.first_ticket(), Ticket{5});
  queue.take_probes();
  EXPECT_EQ(queue.first_ticket(), Ticket{7});
}

TEST(ReferenceMode, ReportsTheSamplesOfTheStatesOwnFrame) {
  ReferenceMode reference;
  protocol::Settings settings;
  settings.reference.use = protocol::ReferenceUse::always;
  reference.report_frame(3, 12, true);
  EXPECT_EQ(reference.state(settings, 3, 1).samples, 12u);
  EXPECT_TRUE(reference.state(settings, 3, 1).finished);
  EXPECT_EQ(reference.state(settings, 4, 1).samples, 0u) << "the frame is of an older state";
}

TEST(ReferenceMode, StopRestoresTheSettingsFromBeforeTheFirstStart) {
  ReferenceMode reference;
  protocol::Settings before;
  before.accumulation.max_samples = 5;
  reference.start(before);
  protocol::Settings started = before;
  started.accumulation.max_samples = 9;
  reference.start(started);
  EXPECT_TRUE(reference.started());
  EXPECT_EQ(reference.stop_patch().value()["accumulation"]["max_samples"], 5);
  reference.settings_changed(before);
  EXPECT_FALSE(reference.started());
  EXPECT_FALSE(reference.stop_patch().value().contains("accumulation"));
}

}  // namespace
}  // namespace heliograph::session
