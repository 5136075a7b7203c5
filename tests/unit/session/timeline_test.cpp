#include "session/state/timeline.hpp"

#include <gtest/gtest.h>

namespace heliograph::session {
namespace {

using protocol::ErrorCode;
using namespace std::chrono_literals;

const Clock::time_point zero{};

StepRequest frames(std::uint32_t count, double dt, std::string viewer = {}) {
  return {.frames = count, .dt = dt, .viewer = std::move(viewer), .done = [](auto) {}};
}

class TimelineTest : public testing::Test {
 protected:
  TimelineTest() { timeline_.enter_lockstep(); }

  void add(StepRequest request) {
    timeline_.add_step(std::move(request), {.lockstep = timeline_.lockstep_time()}, 0);
  }

  Timeline timeline_{2};
};

TEST(Timeline, GivesTicketsInLockstepOnly) {
  Timeline timeline(1);
  EXPECT_EQ(timeline.next_ticket(), std::nullopt);
  timeline.enter_lockstep();
  EXPECT_EQ(timeline.next_ticket(), Ticket{1});
  EXPECT_EQ(timeline.next_ticket(), Ticket{2});
}

TEST(Timeline, SeekRequiresAClip) {
  EXPECT_EQ(Timeline(1).seek(1.0).error().code, ErrorCode::not_ready);
}

TEST_F(TimelineTest, RequestedStepsAdvanceTheTimeAtOnce) {
  add(frames(3, 0.5));
  EXPECT_EQ(timeline_.lockstep_time(), zero + 1500ms);
  const auto first = timeline_.begin_step({}, 0);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->state.lockstep, zero + 500ms) << "a frame shows its own time";
}

TEST_F(TimelineTest, ALostFrameIsRenderedAgainAtTheSameTime) {
  add(frames(2, 0.5));
  const auto lost = timeline_.begin_step({}, 0);
  const auto again = timeline_.begin_step({}, 0);
  ASSERT_TRUE(lost && again);
  EXPECT_EQ(lost->state.lockstep, again->state.lockstep);
}

TEST_F(TimelineTest, AStepWaitsForEarlierReads) {
  const auto read = timeline_.next_ticket();
  add(frames(1, 0.5));
  EXPECT_FALSE(timeline_.step_due(read));
  EXPECT_FALSE(timeline_.begin_step(read, 0));
  EXPECT_TRUE(timeline_.begin_step(timeline_.next_ticket(), 0));
}

TEST_F(TimelineTest, RemovedStepsGiveTheirTimeBackButForFramesThatBegan) {
  add(frames(4, 0.5, "departed"));
  add(frames(1, 1.0));
  ASSERT_TRUE(timeline_.begin_step({}, 0));
  const auto removed =
      timeline_.remove_steps([](const StepRequest& step) { return step.viewer == "departed"; });
  EXPECT_EQ(removed.size(), 1u);
  EXPECT_EQ(timeline_.lockstep_time(), zero + 1500ms);
  EXPECT_EQ(timeline_.begin_step({}, 0)->state.lockstep, zero + 1500ms);
}

TEST_F(TimelineTest, LimitsPendingSteps) {
  add(frames(1, 0.5));
  EXPECT_TRUE(timeline_.check_capacity());
  add(frames(1, 0.5));
  EXPECT_EQ(timeline_.check_capacity().error().code, ErrorCode::full);
}

TEST_F(TimelineTest, TellsWhetherAStepShowsTheNewestState) {
  add(frames(2, 0.5));
  EXPECT_TRUE(timeline_.begin_step({}, 0)->is_current);
  EXPECT_FALSE(timeline_.begin_step({}, 1)->is_current) << "a command came after it";
}

}  // namespace
}  // namespace heliograph::session
