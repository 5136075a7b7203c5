#include "cli/render/render_plan.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace heliograph::cli {
namespace {

scene::Camera camera_at(const std::string& name, const glm::vec3& eye) {
  scene::Camera camera;
  camera.name = name;
  camera.eye = eye;
  camera.target = {1.0f, 0.0f, 0.0f};
  return camera;
}

/// A box around (1, 0, 0), two cameras and a clip of two seconds.
scene::Scene box() {
  scene::Scene scene;
  scene.bounds.include(glm::vec3(0.0f, -1.0f, -1.0f));
  scene.bounds.include(glm::vec3(2.0f, 1.0f, 1.0f));
  scene.nodes = {{.name = "hand"}};
  scene.cameras = {camera_at("front", {1.0f, 0.5f, 4.0f}), camera_at("side", {5.0f, 0.0f, 0.0f})};
  scene.clips = {{.name = "wave", .duration = 2.0f, .channels = {}}};
  return scene;
}

std::string failure(const protocol::RenderRequest& options, const scene::Scene& scene = box()) {
  try {
    plan_shots(scene, scene.bounds, options);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(FrameSize, OneSideGivesTheOther) {
  const auto size = [](std::optional<std::uint32_t> width, std::optional<std::uint32_t> height) {
    protocol::RenderRequest options;
    options.width = width;
    options.height = height;
    const FrameSize result = frame_size(options);
    return std::pair{result.width, result.height};
  };
  EXPECT_EQ(size({}, {}), std::pair(1280u, 720u));
  EXPECT_EQ(size(1920, {}), std::pair(1920u, 1080u));
  EXPECT_EQ(size({}, 360), std::pair(640u, 360u));
  EXPECT_EQ(size(100, 900), std::pair(100u, 900u));
  EXPECT_EQ(size(16, {}), std::pair(16u, 16u)) << "within the limits of a frame";
  EXPECT_EQ(size({}, 16384), std::pair(16384u, 16384u));
}

TEST(Shots, CamerasAreChosenByNameNumberOrAllOfThem) {
  protocol::RenderRequest options;
  EXPECT_EQ(plan_shots(box(), box().bounds, options).at(0).camera.name, "front");
  options.camera = "side";
  EXPECT_EQ(plan_shots(box(), box().bounds, options).at(0).camera.name, "side");
  options.camera = "2";
  EXPECT_EQ(plan_shots(box(), box().bounds, options).at(0).camera.name, "side");
  options.camera = "all";
  const auto shots = plan_shots(box(), box().bounds, options);
  ASSERT_EQ(shots.size(), 2u);
  EXPECT_EQ(shots[1].camera.name, "side");
  EXPECT_TRUE(shots[1].cut);
  for (const char* const wrong : {"0", "3", "sidde", "2x"}) {
    options.camera = wrong;
    EXPECT_NE(failure(options).find(wrong), std::string::npos);
  }
  options.camera = "sidde";
  EXPECT_NE(failure(options).find("did you mean side"), std::string::npos);
}

TEST(Shots, ASceneWithoutCamerasIsShownAsAWhole) {
  scene::Scene scene = box();
  scene.cameras.clear();
  protocol::RenderRequest options;
  options.camera = "all";
  EXPECT_EQ(plan_shots(scene, scene.bounds, options).size(), 1u);
  options.camera = "1";
  EXPECT_NE(failure(options, scene).find("no cameras"), std::string::npos);
}

TEST(Shots, AnOrbitAndAFitShowTheWholeScene) {
  protocol::RenderRequest options;
  options.orbit = {90.0f, 0.0f};
  const scene::Camera right = plan_shots(box(), box().bounds, options).at(0).camera;
  EXPECT_EQ(right.name, "orbit");
  EXPECT_NEAR(glm::normalize(right.eye - right.target).x, 1.0f, 1e-6f);
  EXPECT_EQ(right.target, glm::vec3(1.0f, 0.0f, 0.0f));
  options.margin = 0.25;
  EXPECT_GT(plan_shots(box(), box().bounds, options).at(0).camera.eye.x, right.eye.x + 1.0f);
  options.orbit.reset();
  EXPECT_NE(failure(options).find("--fit"), std::string::npos) << "the scene has cameras";
  options.fit = true;
  options.camera = "all";
  const auto shots = plan_shots(box(), box().bounds, options);
  ASSERT_EQ(shots.size(), 2u);
  EXPECT_EQ(shots[1].camera.name, "side");
  EXPECT_NEAR(glm::normalize(shots[1].camera.eye - shots[1].camera.target).x, 1.0f, 1e-6f);
}

TEST(Shots, AFittedTurntableHasOneDistanceForAllFrames) {
  scene::Scene scene = box();
  scene.cameras.clear();
  scene.bounds.include(glm::vec3(9.0f, 0.0f, 0.0f));
  protocol::RenderRequest options;
  const float still = glm::length(plan_shots(scene, scene.bounds, options).at(0).camera.eye -
                                  glm::vec3(4.5f, 0, 0));
  options.turntable = 8;
  const auto shots = plan_shots(scene, scene.bounds, options);
  const float first = glm::distance(shots.at(0).camera.eye, scene.bounds.center());
  EXPECT_GT(first, still) << "its long side comes into view";
  for (const Shot& shot : shots) {
    EXPECT_NEAR(glm::distance(shot.camera.eye, scene.bounds.center()), first, 1e-3f);
  }
}

TEST(Shots, FramesOfAClipFollowEachOther) {
  protocol::RenderRequest options;
  options.clip = "wave";
  options.time = 0.5;
  options.fps = 10.0;
  options.frames = 3;
  const auto shots = plan_shots(box(), box().bounds, options);
  ASSERT_EQ(shots.size(), 3u);
  EXPECT_DOUBLE_EQ(shots[2].seconds, 0.7);
  EXPECT_EQ(shots[2].frame, 2u);
  EXPECT_FALSE(shots[2].cut) << "histories continue";
  EXPECT_EQ(note_on_clip(box(), options), "");
}

TEST(Shots, TimesBeyondTheClipAreTold) {
  protocol::RenderRequest options;
  options.clip = "wave";
  options.time = 2.0;
  EXPECT_EQ(failure(options), "");
  EXPECT_EQ(note_on_clip(box(), options), "");
  options.frames = 2;
  EXPECT_NE(note_on_clip(box(), options).find("from 1 on"), std::string::npos);
  options.time = 2.01;
  EXPECT_NE(failure(options).find("2 s long"), std::string::npos);
  options.clip = "wafe";
  EXPECT_NE(failure(options).find("did you mean wave"), std::string::npos);
}

TEST(Shots, ATurntableKeepsItsDistanceFromTheMiddleOfTheScene) {
  protocol::RenderRequest options;
  options.turntable = 4;
  const auto shots = plan_shots(box(), box().bounds, options);
  ASSERT_EQ(shots.size(), 4u);
  const glm::vec3 middle(1.0f, 0.0f, 0.0f);
  EXPECT_EQ(shots[0].camera.eye, glm::vec3(1.0f, 0.5f, 4.0f));
  EXPECT_NEAR(glm::distance(shots[2].camera.eye, glm::vec3(1.0f, 0.5f, -4.0f)), 0.0f, 1e-5f);
  for (const Shot& shot : shots) {
    EXPECT_NEAR(glm::distance(shot.camera.eye, middle), glm::length(glm::vec3(0.0f, 0.5f, 4.0f)),
                1e-5f);
    EXPECT_TRUE(shot.cut) << "no history of another view";
  }
}

}  // namespace
}  // namespace heliograph::cli
