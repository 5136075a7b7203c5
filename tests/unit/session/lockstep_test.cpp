#include <gtest/gtest.h>

#include <optional>
#include <thread>
#include <vector>

#include "session/state/session.hpp"

namespace heliograph::session {
namespace {

using protocol::ErrorCode;
using protocol::Result;
using protocol::StepState;

LoadedScene clockwork() {
  auto scene = std::make_shared<scene::Scene>();
  scene->bounds.include(glm::vec3(-1.0f));
  scene->bounds.include(glm::vec3(1.0f));
  scene->nodes = {{.name = "hand"}};
  scene->clips = {{.name = "tick", .duration = 100.0f, .channels = {}}};
  return {.name = "clockwork", .scene = scene, .resources = nullptr};
}

class LockstepTest : public testing::Test {
 protected:
  LockstepTest() { session_.show(clockwork(), ""); }

  /// Asks for frames; the answer is kept.
  Result<void> ask(std::uint32_t frames, double dt) {
    answer_.reset();
    return session_.request_step(
        {.frames = frames, .dt = dt, .done = [this](Result<StepState> state) {
           answer_ = std::move(state);
         }});
  }
  /// What the render thread does.
  int draw_all() {
    int drawn = 0;
    while (const auto frame = session_.begin_step({})) {
      session_.end_step(*frame, 7);
      ++drawn;
    }
    return drawn;
  }

  Session session_{{}, std::make_shared<WakeEvent>()};
  std::optional<Result<StepState>> answer_;
};

TEST_F(LockstepTest, AnswersWhenTheLastFrameIsDone) {
  ASSERT_TRUE(ask(2, 0.5));
  auto frame = session_.begin_step({});
  EXPECT_DOUBLE_EQ(frame.value().seconds, 0.5);
  session_.end_step(*frame, 1);
  EXPECT_FALSE(answer_);
  frame = session_.begin_step({});
  session_.end_step(frame.value(), 2);
  ASSERT_TRUE(answer_ && *answer_);
  EXPECT_EQ((**answer_).frames, 2u);
  EXPECT_EQ((**answer_).samples, 2u);
  EXPECT_DOUBLE_EQ((**answer_).seconds, 1.0);
  EXPECT_FALSE(session_.begin_step({})) << "one frame too many";
}

TEST_F(LockstepTest, IsEnteredWithoutAFrame) {
  ASSERT_TRUE(ask(0, 0.1));
  ASSERT_TRUE(answer_ && *answer_);
  EXPECT_TRUE((**answer_).lockstep);
  EXPECT_TRUE(session_.in_lockstep());
  EXPECT_EQ(draw_all(), 0);
}

TEST_F(LockstepTest, TimePassesByStepsAlone) {
  ASSERT_TRUE(ask(0, 0.1));
  ASSERT_TRUE(session_.play({.clip = "tick", .rate = 2.0}));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_DOUBLE_EQ(session_.animation()->seconds, 0.0);
  ASSERT_TRUE(ask(3, 0.25));
  EXPECT_EQ(draw_all(), 3);
  EXPECT_DOUBLE_EQ(session_.animation()->seconds, 1.5);
  EXPECT_DOUBLE_EQ(session_.render_state().animation.at(session_.render_state().now()), 1.5);
}

TEST_F(LockstepTest, BeginsAnewOnceAndOnEveryReturn) {
  const auto starts = [&] { return session_.render_state().reset_count; };
  const auto before = starts();
  ASSERT_TRUE(ask(1, 0.1));
  ASSERT_TRUE(ask(1, 0.1));
  EXPECT_EQ(starts(), before + 1);
  draw_all();
  session_.run_freely();
  EXPECT_EQ(starts(), before + 1);
  ASSERT_TRUE(ask(1, 0.1));
  draw_all();
  EXPECT_EQ(starts(), before + 2);
  EXPECT_EQ((**answer_).frames, 1u);
}

TEST_F(LockstepTest, RunningFreelyEndsWhatIsDue) {
  ASSERT_TRUE(ask(5, 0.1));
  const auto frame = session_.begin_step({});
  ASSERT_TRUE(frame);
  session_.end_step(*frame, 1);
  EXPECT_FALSE(session_.run_freely().lockstep);
  ASSERT_TRUE(answer_);
  EXPECT_EQ(answer_->error().code, ErrorCode::conflict);
  session_.end_step(*frame, 2);
  EXPECT_FALSE(session_.begin_step({}));
}

TEST_F(LockstepTest, DrawsTheStateAsItWasWhenAsked) {
  ASSERT_TRUE(ask(2, 0.5));
  ASSERT_TRUE(session_.play({.clip = "tick"}));
  ASSERT_TRUE(session_.orbit_camera({.yaw = 90.0}, ""));
  const auto now = session_.render_state();
  ASSERT_TRUE(ask(1, 0.25));
  std::vector<StepFrame> frames;
  while (const auto frame = session_.begin_step({})) {
    frames.push_back(*frame);
    session_.end_step(*frame, 1);
  }
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_LT(frames[0].state.version, frames[1].state.version);
  EXPECT_LT(frames[1].state.version, frames[2].state.version);
  EXPECT_FALSE(frames[1].state.animation.playing);
  EXPECT_NE(frames[1].state.camera.eye, now.camera.eye);
  EXPECT_EQ(frames[2].state.camera.eye, now.camera.eye);
  // It was started after the first step, whether that was drawn by then or not.
  EXPECT_DOUBLE_EQ(frames[2].state.animation.at(*frames[2].state.lockstep), 0.25);
  EXPECT_EQ(frames[2].state.version, session_.version()) << "the newest state is drawn";
}

TEST_F(LockstepTest, WhatReadsThePictureHasItsTurnAmongTheSteps) {
  ASSERT_TRUE(ask(1, 0.5));
  ASSERT_TRUE(session_.request_probe({}));
  ASSERT_TRUE(ask(1, 0.5));
  EXPECT_EQ(draw_all(), 1) << "nobody has taken the probe yet";
  const auto probes = session_.take_probes();
  ASSERT_EQ(probes.size(), 1u);
  EXPECT_FALSE(session_.begin_step(probes[0].place));
  EXPECT_FALSE(session_.step_due(probes[0].place));
  EXPECT_TRUE(session_.step_due({}));
  EXPECT_EQ(draw_all(), 1) << "it was read";
}

TEST_F(LockstepTest, WhoLeavesTakesItsStepsAlong) {
  ASSERT_TRUE(ask(1, 0.5));
  std::optional<Result<StepState>> told;
  ASSERT_TRUE(session_.request_step(
      {.frames = 10, .dt = 1.0, .viewer = "gone", .done = [&](auto state) { told = state; }}));
  ASSERT_TRUE(ask(1, 0.5));
  session_.end_step(*session_.begin_step({}), 1);
  const auto begun = session_.begin_step({});
  session_.leave("gone");
  session_.end_step(*begun, 2);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->error().code, ErrorCode::not_found);
  EXPECT_EQ(draw_all(), 1);
  EXPECT_EQ((**answer_).frames, 3u);
  EXPECT_DOUBLE_EQ((**answer_).seconds, 2.0) << "the frame that had begun took its time";
}

TEST_F(LockstepTest, NeedsAScene) {
  session_.unload("");
  EXPECT_EQ(ask(1, 0.1).error().code, ErrorCode::not_ready);
}

}  // namespace
}  // namespace heliograph::session
