#include <gtest/gtest.h>

#include "session/session.hpp"

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

/// A scene whose camera is moved by one of its two clips.
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

TEST(AnimationClock, AdvancesAtItsRateWhilePlaying) {
  const auto start = AnimationClock::Clock::now();
  AnimationClock clock{
      .clip = "ride", .seconds = 1.0, .rate = 2.0, .playing = true, .since = start};
  EXPECT_DOUBLE_EQ(clock.at(start + std::chrono::milliseconds(500)), 2.0);
  clock.playing = false;
  EXPECT_DOUBLE_EQ(clock.at(start + std::chrono::hours(1)), 1.0);
}

TEST_F(AnimationTest, RequiresASceneWithClips) {
  EXPECT_EQ(session_.timeline().play({}).error().code, ErrorCode::not_ready);
  LoadedScene still = carousel();
  still.scene = std::make_shared<scene::Scene>();
  session_.scene().show(still, "");
  EXPECT_EQ(session_.timeline().play({}).error().code, ErrorCode::not_found);
  EXPECT_EQ(session_.timeline().seek({1.0}).error().code, ErrorCode::not_ready);
}

TEST_F(AnimationTest, PlaysSeeksAndPauses) {
  session_.scene().show(carousel(), "");
  EXPECT_EQ(session_.timeline().animation()->clips.size(), 2u);
  EXPECT_EQ(session_.timeline().animation()->clip, std::nullopt);
  EXPECT_EQ(session_.timeline().play({.clip = "rode", .rate = {}}).error().code,
            ErrorCode::not_found);
  const auto playing = session_.timeline().play({.clip = {}, .rate = 0.5});
  ASSERT_TRUE(playing);
  EXPECT_EQ(playing->clip, "ride") << "the first, when none is named";
  EXPECT_TRUE(playing->playing);
  const auto before = session_.version();
  ASSERT_TRUE(session_.timeline().pause());
  EXPECT_GT(session_.version(), before) << "the renderer must take it over";
  ASSERT_TRUE(session_.timeline().seek({2.5}));
  EXPECT_DOUBLE_EQ(session_.timeline().animation()->seconds, 2.5) << "paused";
  EXPECT_DOUBLE_EQ(session_.timeline().play({})->rate, 0.5);
  EXPECT_GE(session_.timeline().animation()->seconds, 2.5) << "goes on from there";
  session_.scene().show(carousel(), "");
  EXPECT_EQ(session_.timeline().animation()->clip, std::nullopt)
      << "another scene starts without a clip";
}

TEST_F(AnimationTest, TheCameraFollowsTheClipUntilItIsSet) {
  session_.scene().show(carousel(), "");
  EXPECT_FALSE(session_.render_state().camera_follows);
  ASSERT_TRUE(session_.timeline().play({.clip = "pass by", .rate = {}}));
  EXPECT_FALSE(session_.render_state().camera_follows) << "the clip does not move the camera";
  ASSERT_TRUE(session_.timeline().play({.clip = "ride", .rate = {}}));
  EXPECT_TRUE(session_.render_state().camera_follows);
  protocol::CameraSet moved;
  moved.eye = protocol::Vec3{0, 0, 9};
  ASSERT_TRUE(session_.camera().set(moved, ""));
  EXPECT_FALSE(session_.render_state().camera_follows);
  protocol::CameraSet named;
  named.name = "rider";
  ASSERT_TRUE(session_.camera().set(named, ""));
  EXPECT_TRUE(session_.render_state().camera_follows) << "selected again";
}

}  // namespace
}  // namespace heliograph::session
