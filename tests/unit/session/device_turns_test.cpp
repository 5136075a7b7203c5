#include "session/rendering/device_turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <list>

namespace heliograph::session {
namespace {

using namespace std::chrono_literals;

/// Simulates a device with views that are ready for their next frame a pause after the last one.
class DeviceTurnsTest : public testing::Test {
 protected:
  using Milliseconds = std::chrono::milliseconds;

  struct View {
    Milliseconds cost;
    TurnKind kind = TurnKind::moving;
    Milliseconds pause{0};
    Clock::time_point ready{};
    Milliseconds worked{0};
    int frames = 0;
    Milliseconds longest_wait{0};  // from being ready to the beginning
  };

  View& add(const View& view) {
    views_.push_back(view);
    views_.back().ready = time_;
    return views_.back();
  }

  void run_for(Milliseconds duration) {
    for (const Clock::time_point end = time_ + duration; time_ < end;) {
      if (View* const next = choose()) {
        draw(*next);
      } else {
        time_ += 1ms;
      }
    }
  }

  View* choose() {
    std::vector<DeviceTurns::Contender> contenders;
    for (View& view : views_) contenders.push_back({.view = &view, .kind = view.kind});
    turns_.sort(contenders);
    for (const DeviceTurns::Contender& contender : contenders) {
      auto* const view = static_cast<View*>(const_cast<void*>(contender.view));
      if (view->ready <= time_ && !turns_.hold_back(contender, time_)) return view;
    }
    return nullptr;
  }

  void draw(View& view) {
    const auto waited = std::chrono::duration_cast<Milliseconds>(time_ - view.ready);
    view.longest_wait = std::max(view.longest_wait, waited);
    const DeviceTurns::Frame frame = turns_.begin(time_);
    time_ += view.cost;
    view.worked += view.cost;
    ++view.frames;
    view.ready = time_ + (view.kind == TurnKind::starting ? 1h : view.pause);
    turns_.finish({.view = &view, .kind = view.kind}, frame, time_);
  }

  void add_starting(int count) {
    for (int i = 0; i < count; ++i) add({.cost = 15ms, .kind = TurnKind::starting});
  }

  bool all_have_started() const {
    return std::ranges::all_of(views_, [](const View& view) { return view.frames > 0; });
  }

  DeviceTurns turns_;
  std::list<View> views_;
  Clock::time_point time_{1h};
};

TEST_F(DeviceTurnsTest, ManyRefiningViewsDelayAMovingOneByOneFrame) {
  for (int i = 0; i < 49; ++i) add({.cost = 40ms, .kind = TurnKind::refining});
  View& moving = add({.cost = 20ms, .pause = 4ms});
  run_for(10s);
  EXPECT_LE(moving.longest_wait, 40ms);
  EXPECT_GE(moving.worked, 4000ms);
  for (const View& view : views_) EXPECT_GE(view.frames, 2) << "starved";
}

TEST_F(DeviceTurnsTest, AnOverloadThatEndsLeavesNoBacklog) {
  for (int i = 0; i < 50; ++i) add({.cost = 20ms, .pause = 4ms});
  run_for(10s);
  View& moving = views_.front();
  for (View& view : views_) view.kind = &view == &moving ? TurnKind::moving : TurnKind::refining;
  run_for(1s);
  moving.longest_wait = {};
  run_for(10s);
  EXPECT_LE(moving.longest_wait, 40ms);
}

TEST_F(DeviceTurnsTest, ARefiningViewThatMovesAgainIsDrawnNext) {
  for (int i = 0; i < 50; ++i) add({.cost = 40ms, .kind = TurnKind::refining});
  run_for(10s);
  View& moving = views_.front();
  moving.kind = TurnKind::moving;
  moving.ready = time_;
  moving.longest_wait = {};
  run_for(1s);
  EXPECT_LE(moving.longest_wait, 40ms);
}

TEST_F(DeviceTurnsTest, RefiningViewsShareAllOfAnIdleDeviceEqually) {
  for (int i = 0; i < 4; ++i) add({.cost = 10ms, .kind = TurnKind::refining});
  run_for(4s);
  for (const View& view : views_) EXPECT_EQ(view.frames, 100);
}

TEST_F(DeviceTurnsTest, OneOfEachKindHasHalfOfTheDevice) {
  View& refining = add({.cost = 40ms, .kind = TurnKind::refining});
  View& moving = add({.cost = 20ms});
  run_for(10s);
  EXPECT_NEAR(static_cast<double>(refining.worked.count()), 5000.0, 100.0);
  EXPECT_NEAR(static_cast<double>(moving.worked.count()), 5000.0, 100.0);
}

TEST_F(DeviceTurnsTest, SessionsThatOpenDelayAMovingOneByOneFirstFrame) {
  View& moving = add({.cost = 2ms, .pause = 1ms});
  run_for(1s);
  moving.longest_wait = {};
  add_starting(16);
  run_for(400ms);
  EXPECT_TRUE(all_have_started());
  EXPECT_LE(moving.longest_wait, 15ms);
}

TEST_F(DeviceTurnsTest, FirstFramesComeSoonBesideManyMovingViews) {
  for (int i = 0; i < 16; ++i) add({.cost = 2ms, .pause = 1ms});
  run_for(1s);
  add_starting(16);
  run_for(1s);
  EXPECT_TRUE(all_have_started());
}

TEST_F(DeviceTurnsTest, FirstFramesAloneWaitForNothing) {
  add_starting(16);
  run_for(16 * 15ms);
  EXPECT_TRUE(all_have_started());
}

TEST_F(DeviceTurnsTest, FramesThatOverlapPayEqualParts) {
  constexpr std::size_t at_once = 8;
  for (std::size_t i = 0; i < 2 * at_once; ++i) add({.cost = 16ms});
  for (int round = 0; round < 100; ++round) {
    std::vector<DeviceTurns::Contender> contenders;
    for (View& view : views_) contenders.push_back({.view = &view});
    turns_.sort(contenders);
    contenders.resize(at_once);
    std::vector<DeviceTurns::Frame> frames(at_once);
    for (DeviceTurns::Frame& frame : frames) frame = turns_.begin(time_);
    time_ += 16ms;
    for (std::size_t i = 0; i < at_once; ++i) {
      time_ += 1us;
      turns_.finish(contenders[i], frames[i], time_);
      ++static_cast<View*>(const_cast<void*>(contenders[i].view))->frames;
    }
  }
  for (const View& view : views_) EXPECT_EQ(view.frames, 50);
}

TEST_F(DeviceTurnsTest, RefiningFramesThatOverlapAreExpectedBack) {
  View& refining = add({.cost = 16ms, .kind = TurnKind::refining, .pause = 5ms});
  View& moving = add({.cost = 20ms, .kind = TurnKind::refining});
  for (int i = 0; i < 50; ++i) {
    const DeviceTurns::Frame first = turns_.begin(time_);
    const DeviceTurns::Frame second = turns_.begin(time_ + 8ms);
    turns_.finish({.view = &refining, .kind = TurnKind::refining}, first, time_ + 16ms);
    turns_.finish({.view = &moving, .kind = TurnKind::refining}, second, time_ + 24ms);
    time_ += 24ms;
  }
  refining.ready = moving.ready = time_;
  moving.kind = TurnKind::moving;
  run_for(30s);
  EXPECT_GT(1.1 * refining.worked, moving.worked) << "the device does not wait long enough";
}

TEST_F(DeviceTurnsTest, AFrameThatWasDroppedSharesNoTime) {
  View& first = add({.cost = 6ms});
  View& second = add({.cost = 10ms});
  turns_.finish({.view = &first}, turns_.begin(time_), time_ + 6ms);
  turns_.begin(time_ + 6ms);
  turns_.drop(time_ + 7ms);
  turns_.finish({.view = &second}, turns_.begin(time_ + 7ms), time_ + 17ms);
  std::vector<DeviceTurns::Contender> contenders{{.view = &second}, {.view = &first}};
  turns_.sort(contenders);
  EXPECT_EQ(contenders.front().view, &first) << "a frame of 10 ms counts as half of one";
}

TEST_F(DeviceTurnsTest, ARemovedViewHasNoDebt) {
  const int key = 0;
  const int other = 0;
  turns_.finish({.view = &key, .kind = TurnKind::refining}, turns_.begin(time_), time_ + 10s);
  turns_.remove(&key);
  turns_.finish({.view = &other, .kind = TurnKind::refining}, turns_.begin(time_ + 10s),
                time_ + 11s);
  std::vector<DeviceTurns::Contender> contenders{{.view = &other, .kind = TurnKind::refining},
                                                 {.view = &key, .kind = TurnKind::refining}};
  turns_.sort(contenders);
  EXPECT_EQ(contenders.front().view, &key);
}

}  // namespace
}  // namespace heliograph::session
