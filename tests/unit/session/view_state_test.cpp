#include "session/rendering/view_state.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace heliograph::session {
namespace {

using namespace std::chrono_literals;

const Clock::time_point view_start{1h};

/// A converged, static view at `after` its last change, whose final frame is not sent yet.
ViewInputs static_view(std::chrono::milliseconds after) {
  return {.now = view_start + after,
          .camera_moved_at = view_start,
          .state_changed_at = view_start,
          .has_frame = true,
          .converged = true};
}

TEST(ViewState, FollowsItsTableOfTransitions) {
  struct Row {
    std::string name;
    ViewState expected;
    ViewInputs in;
  };
  const auto with = [](std::chrono::milliseconds after, auto change) {
    ViewInputs in = static_view(after);
    change(in);
    return in;
  };
  const auto unchanged = [](ViewInputs&) {};
  const auto needs_frame = [](ViewInputs& in) { in.needs_frame = true; };
  const auto sent = [](ViewInputs& in) { in.final_sent = true; };
  const std::vector<Row> table{
      {"just changed", ViewState::moving, with(0ms, needs_frame)},
      {"just changed, nothing to draw", ViewState::moving, with(149ms, unchanged)},
      {"static, samples missing", ViewState::refining, with(150ms, needs_frame)},
      {"static for long, samples missing", ViewState::refining, with(1h, needs_frame)},
      {"converged, not static for long enough", ViewState::refining, with(299ms, unchanged)},
      {"converged and static", ViewState::final, with(300ms, unchanged)},
      {"final frame sent", ViewState::idle, with(300ms, sent)},
      {"final frame sent early", ViewState::idle, with(200ms, sent)},
      {"an older final frame was sent", ViewState::refining,
       with(300ms,
            [](ViewInputs& in) {
              in.final_sent = true;
              in.needs_frame = true;
            })},
      {"no scene", ViewState::idle, with(1h, [](ViewInputs& in) { in.has_frame = false; })},
      {"first frame", ViewState::refining,
       with(1h,
            [](ViewInputs& in) {
              in.has_frame = false;
              in.needs_frame = true;
            })},
      {"never converges", ViewState::idle, with(1h, [](ViewInputs& in) { in.converged = false; })},
      {"a change is not taken over yet", ViewState::moving,
       with(1h, [](ViewInputs& in) { in.newer_state = true; })},
      {"a clip plays", ViewState::moving,
       with(1h, [](ViewInputs& in) { in.animation_playing = true; })},
      {"lockstep", ViewState::moving, with(1h, [](ViewInputs& in) { in.lockstep = true; })},
      {"drawn at reduced size", ViewState::moving,
       with(200ms, [](ViewInputs& in) { in.reduced_size = true; })},
  };
  for (const Row& row : table) EXPECT_EQ(next_view_state(row.in), row.expected) << row.name;
}

TEST(ViewState, FramesOfACameraAtRestAreInterrupted) {
  ViewInputs in = static_view(1h);
  in.needs_frame = true;
  EXPECT_EQ(interruption(in), Interruption::any_change) << "refining";
  in.state_changed_at = in.now;  // a setting, or the scene
  EXPECT_EQ(interruption(in), Interruption::camera_move);
  in.animation_playing = true;
  EXPECT_EQ(interruption(in), Interruption::none);
  in.animation_playing = false;
  // The frame after the interruption: that of a camera that moves is finished.
  in.camera_moved_at = in.now;
  EXPECT_EQ(interruption(in), Interruption::none);
  in.camera_moved_at = in.now - final_delay;
  in.reduced_size = true;
  EXPECT_EQ(interruption(in), Interruption::none);
}

TEST(ViewState, WakesUpForTheFinalFrame) {
  EXPECT_EQ(next_view_transition(static_view(100ms)), view_start + final_delay);
  EXPECT_EQ(next_view_transition(static_view(300ms)), std::nullopt) << "the time has come";
  ViewInputs in = static_view(100ms);
  in.final_sent = true;
  EXPECT_EQ(next_view_transition(in), std::nullopt);
  in = static_view(100ms);
  in.converged = false;
  EXPECT_EQ(next_view_transition(in), std::nullopt);
  in = static_view(100ms);
  in.lockstep = true;
  EXPECT_EQ(next_view_transition(in), std::nullopt) << "in lockstep only steps draw";
}

TEST(ViewState, WakesUpToReturnToFullSize) {
  ViewInputs in = static_view(100ms);
  in.converged = false;
  in.reduced_size = true;
  in.state_changed_at = view_start - 1h;
  EXPECT_EQ(next_view_transition(in), view_start + final_delay);
}

TEST(DrawPolicy, ReducesTheSizeAndFollowsViewersOnlyWhileMoving) {
  for (const ViewState state :
       {ViewState::moving, ViewState::refining, ViewState::final, ViewState::idle}) {
    const bool moving = state == ViewState::moving;
    EXPECT_EQ(draw_policy(state).dynamic_resolution, moving);
    EXPECT_EQ(draw_policy(state).pace == Pace::viewers, moving);
    EXPECT_EQ(draw_policy(state).purpose == FramePurpose::interactive, moving);
  }
}

TEST(ShouldDraw, OnlyWhereAFrameIsNeeded) {
  const FrameDemand all{.requested = true, .active_viewer = true, .viewer_accepts = true};
  EXPECT_FALSE(should_draw(ViewState::moving, all));
  EXPECT_FALSE(should_draw(ViewState::refining, all));
}

TEST(ShouldDraw, RequestedFramesInAnyState) {
  const FrameDemand requested{.needs_frame = true, .requested = true, .encoder_behind = true};
  for (const ViewState state :
       {ViewState::moving, ViewState::refining, ViewState::final, ViewState::idle}) {
    EXPECT_TRUE(should_draw(state, requested));
  }
}

TEST(ShouldDraw, AtThePaceOfViewersWhileMoving) {
  FrameDemand demand{.needs_frame = true, .active_viewer = true};
  EXPECT_FALSE(should_draw(ViewState::moving, demand)) << "no viewer accepts a frame";
  demand.viewer_accepts = true;
  EXPECT_TRUE(should_draw(ViewState::moving, demand));
  demand.encoder_behind = true;
  EXPECT_FALSE(should_draw(ViewState::moving, demand));
}

TEST(ShouldDraw, AtFullSpeedWhileRefiningForAnActiveViewer) {
  FrameDemand demand{.needs_frame = true, .encoder_behind = true};
  EXPECT_FALSE(should_draw(ViewState::refining, demand)) << "no viewer";
  demand.active_viewer = true;
  EXPECT_TRUE(should_draw(ViewState::refining, demand)) << "few of its frames are sent";
}

/// An image of 1280x720 that takes 100 ms at full size, whose camera moved 100 ms ago.
ResolutionInputs moving_image() {
  return {.now = view_start + 100ms,
          .camera_moved_at = view_start,
          .full = {1280, 720},
          .full_frame_time = 100ms,
          .frame_time = 66ms,
          .least_scale = 0.5f};
}

TEST(DrawScale, IsReducedWhileTheCameraMovesAndFramesAreSlow) {
  ResolutionInputs in = moving_image();
  EXPECT_EQ(draw_scale(in), 0.67f);
  in.now = view_start + final_delay;
  EXPECT_EQ(draw_scale(in), 1.0f) << "the camera is static";
  in.animation_playing = true;
  EXPECT_EQ(draw_scale(in), 0.67f);
}

TEST(DrawScale, IsFullForFastFramesSmallImagesAndCaptures) {
  ResolutionInputs fast = moving_image();
  fast.full_frame_time = 66ms;
  EXPECT_EQ(draw_scale(fast), 1.0f);
  ResolutionInputs unknown = moving_image();
  unknown.full_frame_time = {};
  EXPECT_EQ(draw_scale(unknown), 1.0f) << "no moving frame was measured";
  ResolutionInputs small = moving_image();
  small.full = {320, 180};
  EXPECT_EQ(draw_scale(small), 1.0f);
  ResolutionInputs captured = moving_image();
  captured.capture_pending = true;
  EXPECT_EQ(draw_scale(captured), 1.0f);
}

TEST(DrawScale, IsTheLargestStepThatKeepsTheFrameTime) {
  ResolutionInputs in = moving_image();
  in.full_frame_time = 90ms;
  EXPECT_EQ(draw_scale(in), 0.8f);
  in.full_frame_time = 180ms;
  EXPECT_EQ(draw_scale(in), 0.5f);
  in.full_frame_time = 10s;
  EXPECT_EQ(draw_scale(in), 0.5f) << "not below the least scale";
  in.least_scale = 0.7f;
  EXPECT_EQ(draw_scale(in), 0.7f);
  in.least_scale = 1.0f;
  EXPECT_EQ(draw_scale(in), 1.0f);
}

TEST(DrawScale, FollowsTheFrameTimeThatIsAskedFor) {
  ResolutionInputs in = moving_image();
  in.frame_time = 100ms;
  EXPECT_EQ(draw_scale(in), 1.0f);
  in.frame_time = 33ms;
  EXPECT_EQ(draw_scale(in), 0.5f);
  in.frame_time = 0ms;
  in.full_frame_time = 1ms;
  EXPECT_EQ(draw_scale(in), 0.5f) << "always the least";
}

TEST(DrawScale, IsReducedWhereOtherSessionsMoveToo) {
  ResolutionInputs in = moving_image();
  in.full_frame_time = 20ms;
  in.moving_sessions = 3;
  EXPECT_EQ(draw_scale(in), 1.0f);
  in.moving_sessions = 4;
  EXPECT_EQ(draw_scale(in), 0.8f);
  in.moving_sessions = 16;
  EXPECT_EQ(draw_scale(in), 0.5f);
  in.now = view_start + final_delay;
  EXPECT_EQ(draw_scale(in), 1.0f) << "the camera is static";
}

TEST(DrawScale, StaysWhereTimesSwing) {
  ResolutionInputs in = moving_image();
  in.scale = 0.8f;
  in.full_frame_time = 105ms;  // 71 ms at 0.8
  EXPECT_EQ(draw_scale(in), 0.8f);
  in.full_frame_time = 60ms;
  EXPECT_EQ(draw_scale(in), 0.8f) << "too near to the limit at full size";
  in.full_frame_time = 50ms;
  EXPECT_EQ(draw_scale(in), 1.0f);
}

}  // namespace
}  // namespace heliograph::session
