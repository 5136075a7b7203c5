#include <gtest/gtest.h>

#include <optional>
#include <thread>
#include <vector>

#include "session/session.hpp"

namespace heliograph::session {
namespace {

using protocol::ErrorCode;
using protocol::Result;
using protocol::StepState;

LoadedScene scene_with_clip() {
  auto scene = std::make_shared<scene::Scene>();
  scene->bounds.include(glm::vec3(-1.0f));
  scene->bounds.include(glm::vec3(1.0f));
  scene->nodes = {{.name = "hand"}};
  scene->clips = {{.name = "tick", .duration = 100.0f, .channels = {}}};
  return {.name = "clip", .scene = scene, .resources = nullptr};
}

class LockstepTest : public testing::Test {
 protected:
  LockstepTest() { session_.scene().show(scene_with_clip(), ""); }

  /// Requests frames; the answer is stored.
  Result<void> ask(std::uint32_t frames, double dt) {
    answer_.reset();
    return session_.timeline().request_step(
        {.frames = frames, .dt = dt, .done = [this](Result<StepState> state) {
           answer_ = std::move(state);
         }});
  }
  /// Does what the render thread does.
  int draw_all() {
    int drawn = 0;
    while (const auto frame = session_.timeline().begin_step({})) {
      session_.timeline().end_step(*frame, 7);
      ++drawn;
    }
    return drawn;
  }

  Session session_{{}, std::make_shared<WakeEvent>()};
  std::optional<Result<StepState>> answer_;
};

TEST_F(LockstepTest, AnswersAfterTheLastFrame) {
  ASSERT_TRUE(ask(2, 0.5));
  auto frame = session_.timeline().begin_step({});
  EXPECT_DOUBLE_EQ(frame.value().seconds, 0.5);
  session_.timeline().end_step(*frame, 1);
  EXPECT_FALSE(answer_);
  frame = session_.timeline().begin_step({});
  session_.timeline().end_step(frame.value(), 2);
  ASSERT_TRUE(answer_ && *answer_);
  EXPECT_EQ((**answer_).frames, 2u);
  EXPECT_EQ((**answer_).samples, 2u);
  EXPECT_DOUBLE_EQ((**answer_).seconds, 1.0);
  EXPECT_FALSE(session_.timeline().begin_step({})) << "one frame too many";
}

TEST_F(LockstepTest, StepsWithoutACallerAreNotDrawn) {
  const auto gone =
      std::make_shared<protocol::PendingAnswer>(1, std::make_shared<protocol::AnswerMemory>(1));
  std::optional<Result<StepState>> dropped;
  ASSERT_TRUE(session_.timeline().request_step(
      {.frames = 100, .dt = 0.5, .answer = gone, .done = [&](Result<StepState> state) {
         dropped = std::move(state);
       }}));
  ASSERT_TRUE(ask(2, 0.25));
  session_.timeline().fail_abandoned_steps();
  EXPECT_FALSE(dropped) << "the caller still waits";
  gone->abandon();
  session_.timeline().fail_abandoned_steps();
  ASSERT_TRUE(dropped);
  EXPECT_EQ(dropped->error().code, ErrorCode::conflict);
  EXPECT_EQ(draw_all(), 2) << "those of another caller";
  EXPECT_DOUBLE_EQ((**answer_).seconds, 0.5) << "the time of dropped frames does not pass";
}

TEST_F(LockstepTest, ZeroFramesEnterLockstep) {
  ASSERT_TRUE(ask(0, 0.1));
  ASSERT_TRUE(answer_ && *answer_);
  EXPECT_TRUE((**answer_).lockstep);
  EXPECT_TRUE(session_.timeline().in_lockstep());
  EXPECT_EQ(draw_all(), 0);
}

TEST_F(LockstepTest, OnlyStepsAdvanceTime) {
  ASSERT_TRUE(ask(0, 0.1));
  ASSERT_TRUE(session_.timeline().play({.clip = "tick", .rate = 2.0}));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_DOUBLE_EQ(session_.timeline().animation()->seconds, 0.0);
  ASSERT_TRUE(ask(3, 0.25));
  EXPECT_EQ(draw_all(), 3);
  EXPECT_DOUBLE_EQ(session_.timeline().animation()->seconds, 1.5);
  EXPECT_DOUBLE_EQ(session_.render_state().animation.at(session_.render_state().now()), 1.5);
}

TEST_F(LockstepTest, ResetsHistoriesEachTimeItIsEntered) {
  const auto starts = [&] { return session_.render_state().reset_count; };
  const auto before = starts();
  ASSERT_TRUE(ask(1, 0.1));
  ASSERT_TRUE(ask(1, 0.1));
  EXPECT_EQ(starts(), before + 1);
  draw_all();
  session_.timeline().leave_lockstep();
  EXPECT_EQ(starts(), before + 1);
  ASSERT_TRUE(ask(1, 0.1));
  draw_all();
  EXPECT_EQ(starts(), before + 2);
  EXPECT_EQ((**answer_).frames, 1u);
}

TEST_F(LockstepTest, LeavingFailsPendingSteps) {
  ASSERT_TRUE(ask(5, 0.1));
  const auto frame = session_.timeline().begin_step({});
  ASSERT_TRUE(frame);
  session_.timeline().end_step(*frame, 1);
  EXPECT_FALSE(session_.timeline().leave_lockstep().lockstep);
  ASSERT_TRUE(answer_);
  EXPECT_EQ(answer_->error().code, ErrorCode::conflict);
  session_.timeline().end_step(*frame, 2);
  EXPECT_FALSE(session_.timeline().begin_step({}));
}

TEST_F(LockstepTest, RendersTheStateAsOfTheRequest) {
  ASSERT_TRUE(ask(2, 0.5));
  ASSERT_TRUE(session_.timeline().play({.clip = "tick"}));
  ASSERT_TRUE(session_.camera().orbit({.yaw = 90.0}, ""));
  const auto now = session_.render_state();
  ASSERT_TRUE(ask(1, 0.25));
  std::vector<StepFrame> frames;
  while (const auto frame = session_.timeline().begin_step({})) {
    frames.push_back(*frame);
    session_.timeline().end_step(*frame, 1);
  }
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_LT(frames[0].state.version, frames[1].state.version);
  EXPECT_LT(frames[1].state.version, frames[2].state.version);
  EXPECT_FALSE(frames[1].state.animation.playing);
  EXPECT_NE(frames[1].state.camera.eye, now.camera.eye);
  EXPECT_EQ(frames[2].state.camera.eye, now.camera.eye);
  // It was started after the first step, whether that was rendered by then or not.
  EXPECT_DOUBLE_EQ(frames[2].state.animation.at(*frames[2].state.lockstep), 0.25);
  EXPECT_EQ(frames[2].state.version, session_.version()) << "the newest state is shown";
}

TEST_F(LockstepTest, ProbesAreReadInTicketOrderAmongSteps) {
  ASSERT_TRUE(ask(1, 0.5));
  ASSERT_TRUE(session_.captures().request_probe({}));
  ASSERT_TRUE(ask(1, 0.5));
  EXPECT_EQ(draw_all(), 1) << "the probe has not been taken yet";
  const auto probes = session_.captures().take_probes();
  ASSERT_EQ(probes.size(), 1u);
  EXPECT_FALSE(session_.timeline().begin_step(probes[0].ticket));
  EXPECT_FALSE(session_.timeline().step_due(probes[0].ticket));
  EXPECT_TRUE(session_.timeline().step_due({}));
  EXPECT_EQ(draw_all(), 1) << "the probe was answered";
}

TEST_F(LockstepTest, StepsOfADepartedViewerFail) {
  ASSERT_TRUE(ask(1, 0.5));
  std::optional<Result<StepState>> failed;
  ASSERT_TRUE(session_.timeline().request_step(
      {.frames = 10, .dt = 1.0, .viewer = "departed", .done = [&](auto state) {
         failed = state;
       }}));
  ASSERT_TRUE(ask(1, 0.5));
  session_.timeline().end_step(*session_.timeline().begin_step({}), 1);
  const auto begun = session_.timeline().begin_step({});
  session_.leave("departed");
  session_.timeline().end_step(*begun, 2);
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->error().code, ErrorCode::not_found);
  EXPECT_EQ(draw_all(), 1);
  EXPECT_EQ((**answer_).frames, 3u);
  EXPECT_DOUBLE_EQ((**answer_).seconds, 2.0) << "the frame that had begun took its time";
}

TEST_F(LockstepTest, RequiresAScene) {
  session_.scene().unload("");
  EXPECT_EQ(ask(1, 0.1).error().code, ErrorCode::not_ready);
}

}  // namespace
}  // namespace heliograph::session
