#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>

#include "session/state/session_core.hpp"

// Cameras on their way from one session to another, in the orders in which threads may bring them.

namespace heliograph::session {
namespace {

using protocol::Vec3;

class CameraFollowingTest : public testing::Test {
 protected:
  CameraFollowingTest() {
    for (SessionCore* const core : {leader_.get(), follower_.get(), last_.get()}) {
      core->scene = scene_;
    }
    begin(*leader_, follower_);
    begin(*follower_, last_);
  }

  static std::shared_ptr<SessionCore> made_core() {
    return std::make_shared<SessionCore>(SessionOptions(), std::make_shared<WakeEvent>(), nullptr);
  }
  static void begin(SessionCore& source, const std::shared_ptr<SessionCore>& follower) {
    source.camera_followers = {{.session = follower, .link = follower->renew_camera_link()}};
  }
  /// Shows a box around the origin: each time it is a jump. `half_width` decides the view.
  static void jump(SessionCore& core, float half_width) {
    scene::Bounds bounds;
    bounds.include(glm::vec3(-half_width));
    bounds.include(glm::vec3(half_width));
    core.camera.fit(bounds, 1.0f);
    core.changed();
  }
  /// Passes the camera of `source` on; how often the follower's jumped for it.
  std::uint64_t jumps_with(const SessionCore& source) const {
    const std::uint64_t before = follower_->camera.discontinuities();
    SessionCore::lead_camera(source.led_camera(), "ada");
    return follower_->camera.discontinuities() - before;
  }
  /// The leader's camera after a move, which is not passed on yet.
  LedCamera moved(Vec3 eye) {
    EXPECT_TRUE(leader_->camera.set({.eye = eye}, *scene_, "ada"));
    leader_->changed();
    return leader_->led_camera();
  }
  static Vec3 eye_of(const SessionCore& core) { return core.camera_message().eye; }

  std::shared_ptr<scene::Scene> scene_ = std::make_shared<scene::Scene>();
  std::shared_ptr<SessionCore> leader_ = made_core();
  std::shared_ptr<SessionCore> follower_ = made_core();
  std::shared_ptr<SessionCore> last_ = made_core();  // follows the follower
};

TEST_F(CameraFollowingTest, AnOlderCameraThatComesLaterIsLeft) {
  const LedCamera older = moved({2, 3, 4});
  const LedCamera newer = moved({5, 6, 7});
  SessionCore::lead_camera(newer, "ada");
  const std::uint32_t rev = follower_->rev;
  SessionCore::lead_camera(older, "ada");
  EXPECT_EQ(eye_of(*follower_), (Vec3{5, 6, 7}));
  EXPECT_EQ(eye_of(*last_), (Vec3{5, 6, 7}));
  EXPECT_EQ(follower_->rev, rev) << "nothing has changed";
}

TEST_F(CameraFollowingTest, AFollowerOfAFollowerDoesNotGoBackEither) {
  const std::uint64_t link = leader_->camera_followers[0].link;
  const auto older = follower_->take_camera(moved({2, 3, 4}), link, "ada");
  ASSERT_TRUE(older);
  SessionCore::lead_camera(moved({5, 6, 7}), "ada");
  SessionCore::lead_camera(*older, "ada");
  EXPECT_EQ(eye_of(*last_), (Vec3{5, 6, 7}));
}

TEST_F(CameraFollowingTest, WhatAnEndedLinkBringsIsLeft) {
  const Vec3 before = eye_of(*follower_);
  const LedCamera late = moved({2, 3, 4});
  (void)follower_->renew_camera_link();
  SessionCore::lead_camera(late, "ada");
  EXPECT_EQ(eye_of(*follower_), before);
}

TEST_F(CameraFollowingTest, ALaterLinkTakesWhatTheOneBeforeHadAlready) {
  SessionCore::lead_camera(moved({2, 3, 4}), "ada");
  ASSERT_TRUE(follower_->camera.set({.eye = Vec3{9, 9, 9}}, *scene_, "bob"));
  begin(*leader_, follower_);
  SessionCore::lead_camera(leader_->led_camera(), "ada");
  EXPECT_EQ(eye_of(*follower_), (Vec3{2, 3, 4}));
}

TEST_F(CameraFollowingTest, AJumpOfTheFollowedCameraIsOneAndAMoveIsNot) {
  jump(*leader_, 1.0f);
  EXPECT_EQ(jumps_with(*leader_), 1u);
  (void)moved({2, 3, 4});
  EXPECT_EQ(jumps_with(*leader_), 0u);
  jump(*leader_, 1.0f);
  jump(*leader_, 2.0f);
  EXPECT_EQ(jumps_with(*leader_), 1u);
}

TEST_F(CameraFollowingTest, TheFirstCameraOfAnotherLeaderJumpsWhereItShowsSomethingElse) {
  const std::shared_ptr<SessionCore> other = made_core();
  other->scene = scene_;
  jump(*leader_, 1.0f);
  (void)jumps_with(*leader_);
  jump(*other, 2.0f);
  ASSERT_EQ(other->camera.discontinuities(), leader_->camera.discontinuities());
  begin(*other, follower_);
  EXPECT_EQ(jumps_with(*other), 1u) << "as often as the one before has";
  begin(*leader_, follower_);
  EXPECT_EQ(jumps_with(*leader_), 1u);
  EXPECT_EQ(jumps_with(*leader_), 0u);
}

TEST_F(CameraFollowingTest, TheFirstCameraOfAnotherLeaderIsNoJumpWhereItShowsTheSame) {
  const std::shared_ptr<SessionCore> other = made_core();
  other->scene = scene_;
  jump(*leader_, 1.0f);
  (void)jumps_with(*leader_);
  jump(*other, 2.0f);
  jump(*other, 1.0f);
  ASSERT_NE(other->camera.discontinuities(), leader_->camera.discontinuities());
  begin(*other, follower_);
  EXPECT_EQ(jumps_with(*other), 0u);
  jump(*other, 2.0f);
  EXPECT_EQ(jumps_with(*other), 1u) << "its jumps are counted from now on";
}

TEST_F(CameraFollowingTest, TheSameLeaderFollowedAgainJumpsBackFromWhatWasShownMeanwhile) {
  jump(*leader_, 1.0f);
  (void)jumps_with(*leader_);
  (void)follower_->renew_camera_link();
  ASSERT_TRUE(follower_->camera.set({.eye = Vec3{9, 9, 9}}, *scene_, "bob"));
  begin(*leader_, follower_);
  EXPECT_EQ(jumps_with(*leader_), 1u) << "though that camera has not jumped";
}

TEST_F(CameraFollowingTest, ACameraInASceneThatComesLaterIsTakenOverWhenBothHaveIt) {
  const std::shared_ptr<SessionCore> main = made_core();
  main->scene = scene_;
  main->followers = {leader_, follower_, last_};
  const Vec3 before = eye_of(*follower_);
  ++leader_->scene_loads;
  const LedCamera early = moved({2, 3, 4});
  SessionCore::lead_camera(early, "ada");
  EXPECT_EQ(eye_of(*follower_), before);
  ++follower_->scene_loads;
  ++last_->scene_loads;
  main->lead_cameras("");
  EXPECT_EQ(eye_of(*follower_), (Vec3{2, 3, 4}));
  EXPECT_EQ(eye_of(*last_), (Vec3{2, 3, 4}));
}

}  // namespace
}  // namespace heliograph::session
