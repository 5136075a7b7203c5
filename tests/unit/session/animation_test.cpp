#include <gtest/gtest.h>

#include "session/state/session.hpp"

namespace heliograph::session {
namespace {

using protocol::ErrorCode;

scene::Channel rise(std::uint32_t node) {
  scene::Channel channel;
  channel.node = node;
  channel.times = {0, 4};
  channel.values = {0, 0, 0, 0, 4, 0};
  return channel;
}

/// A camera that one of two clips carries.
LoadedScene carousel() {
  auto scene = std::make_shared<scene::Scene>();
  scene->bounds.include(glm::vec3(-1.0f));
  scene->bounds.include(glm::vec3(1.0f));
  scene->nodes = {{.name = "rider"}, {.name = "other"}};
  scene->clips = {{"ride", 4.0f, {rise(0)}}, {"pass by", 4.0f, {rise(1)}}};
  scene::Camera camera;
  camera.name = "rider";
  camera.node = 0;
  scene->cameras = {camera};
  return {.name = "carousel", .scene = scene, .resources = nullptr};
}

class AnimationTest : public testing::Test {
 protected:
  Session session_{{}, std::make_shared<WakeEvent>()};
};

TEST(AnimationClock, PassesAtItsRateWhilePlaying) {
  const auto start = AnimationClock::Clock::now();
  AnimationClock clock{
      .clip = "ride", .seconds = 1.0, .rate = 2.0, .playing = true, .since = start};
  EXPECT_DOUBLE_EQ(clock.at(start + std::chrono::milliseconds(500)), 2.0);
  clock.playing = false;
  EXPECT_DOUBLE_EQ(clock.at(start + std::chrono::hours(1)), 1.0);
}

TEST_F(AnimationTest, NeedsASceneWithClips) {
  EXPECT_EQ(session_.play({}).error().code, ErrorCode::not_ready);
  LoadedScene still = carousel();
  still.scene = std::make_shared<scene::Scene>();
  session_.show(still, "");
  EXPECT_EQ(session_.play({}).error().code, ErrorCode::not_found);
  EXPECT_EQ(session_.seek({1.0}).error().code, ErrorCode::not_ready);
}

TEST_F(AnimationTest, PlaysSeeksAndPauses) {
  session_.show(carousel(), "");
  EXPECT_EQ(session_.animation()->clips.size(), 2u);
  EXPECT_EQ(session_.animation()->clip, std::nullopt);
  EXPECT_EQ(session_.play({.clip = "rode", .rate = {}}).error().code, ErrorCode::not_found);
  const auto playing = session_.play({.clip = {}, .rate = 0.5});
  ASSERT_TRUE(playing);
  EXPECT_EQ(playing->clip, "ride") << "the first, when none is named";
  EXPECT_TRUE(playing->playing);
  const auto before = session_.version();
  ASSERT_TRUE(session_.pause());
  EXPECT_GT(session_.version(), before) << "the renderer must hear of it";
  ASSERT_TRUE(session_.seek({2.5}));
  EXPECT_DOUBLE_EQ(session_.animation()->seconds, 2.5) << "paused";
  EXPECT_DOUBLE_EQ(session_.play({})->rate, 0.5);
  EXPECT_GE(session_.animation()->seconds, 2.5) << "goes on from there";
  session_.show(carousel(), "");
  EXPECT_EQ(session_.animation()->clip, std::nullopt) << "another scene starts at rest";
}

TEST_F(AnimationTest, TheCameraFollowsUntilItIsTakenByHand) {
  session_.show(carousel(), "");
  EXPECT_FALSE(session_.render_state().camera_follows);
  ASSERT_TRUE(session_.play({.clip = "pass by", .rate = {}}));
  EXPECT_FALSE(session_.render_state().camera_follows) << "the clip does not move it";
  ASSERT_TRUE(session_.play({.clip = "ride", .rate = {}}));
  EXPECT_TRUE(session_.render_state().camera_follows);
  protocol::CameraSet moved;
  moved.eye = protocol::Vec3{0, 0, 9};
  ASSERT_TRUE(session_.set_camera(moved, ""));
  EXPECT_FALSE(session_.render_state().camera_follows);
  protocol::CameraSet named;
  named.name = "rider";
  ASSERT_TRUE(session_.set_camera(named, ""));
  EXPECT_TRUE(session_.render_state().camera_follows) << "chosen again";
}

}  // namespace
}  // namespace heliograph::session
