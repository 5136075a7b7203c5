#include "session/rendering/fair_share.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

namespace heliograph::session {
namespace {

using namespace std::chrono_literals;

/// Simulates a device that works for sessions with given costs. Each is ready for its next piece a
/// pause after its last, and no sooner than an interval after it began.
class FairShareTest : public testing::Test {
 protected:
  using Milliseconds = std::chrono::milliseconds;

  struct Worker {
    Milliseconds cost;
    Milliseconds pause{0};
    Milliseconds interval{0};
    Clock::time_point ready{};
    Milliseconds worked{0};
    int pieces = 0;
    Milliseconds longest_wait{0};  // from being ready to the beginning
  };

  void run_for(Milliseconds duration) {
    const Clock::time_point end = time_ + duration;
    while (time_ < end) {
      if (Worker* next = choose()) {
        work(*next);
      } else {
        time_ += 1ms;
      }
    }
  }

  Worker* choose() {
    std::vector<FairShare::Key> keys;
    for (auto& [name, worker] : workers_) keys.push_back(&worker);
    share_.sort(keys);
    for (const FairShare::Key key : keys) {
      auto* worker = static_cast<Worker*>(const_cast<void*>(key));
      if (worker->ready <= time_ && !share_.hold_back(key, time_)) return worker;
    }
    return nullptr;
  }

  void work(Worker& worker) {
    const auto waited = std::chrono::duration_cast<Milliseconds>(time_ - worker.ready);
    if (worker.pieces > 0) worker.longest_wait = std::max(worker.longest_wait, waited);
    const Clock::time_point begin = time_;
    time_ += worker.cost;
    worker.worked += worker.cost;
    ++worker.pieces;
    worker.ready = std::max(time_ + worker.pause, begin + worker.interval);
    share_.charge(&worker, begin, time_, worker.cost);
  }

  FairShare share_;
  std::map<std::string, Worker> workers_;
  Clock::time_point time_{1h};
};

TEST_F(FairShareTest, DividesTimeNotFrames) {
  workers_["heavy"] = {.cost = 200ms};
  workers_["light"] = {.cost = 5ms};
  run_for(20s);
  EXPECT_NEAR(static_cast<double>(workers_["light"].worked.count()), 10000.0, 400.0);
  EXPECT_LE(workers_["light"].longest_wait, 200ms) << "more than one heavy piece in between";
}

TEST_F(FairShareTest, WaitsForShortWorkBeforeLongWork) {
  workers_["heavy"] = {.cost = 200ms};
  workers_["light"] = {.cost = 5ms, .pause = 3ms};
  run_for(20s);
  // Half of the time, in pieces of 5 ms with 3 ms between them.
  EXPECT_NEAR(workers_["light"].pieces, 10000 / 8, 125);
  EXPECT_NEAR(static_cast<double>(workers_["heavy"].worked.count()), 10000.0, 1000.0);
}

TEST_F(FairShareTest, WaitsForAViewThatDrawsAtSixtyHertz) {
  workers_["heavy"] = {.cost = 100ms};
  workers_["light"] = {.cost = 5ms, .interval = 16ms};
  run_for(20s);
  EXPECT_GE(workers_["light"].pieces, 550) << "half of the time, one piece in 16 ms";
  EXPECT_GE(workers_["heavy"].worked, 9000ms);
}

TEST_F(FairShareTest, OccasionalPausesCostLittle) {
  workers_["heavy"] = {.cost = 100ms};
  Worker& light = workers_["light"] = {.cost = 5ms, .interval = 16ms};
  for (int second = 0; second < 20; ++second) {
    run_for(1s);
    light.ready = time_ + 300ms;
  }
  EXPECT_GE(light.pieces, 300);
}

TEST_F(FairShareTest, DoesNotWaitForAnIdleView) {
  workers_["heavy"] = {.cost = 100ms};
  Worker& light = workers_["light"] = {.cost = 5ms, .interval = 16ms};
  run_for(2s);
  light.ready = time_ + 1h;
  const auto before = workers_["heavy"].worked;
  run_for(10s);
  EXPECT_GE(workers_["heavy"].worked - before, 9900ms);
}

TEST_F(FairShareTest, BacksOffAfterUnsuccessfulWaits) {
  workers_["heavy"] = {.cost = 200ms};
  workers_["rare"] = {.cost = 5ms, .pause = 60ms};
  run_for(20s);
  EXPECT_GE(workers_["heavy"].worked, 17500ms);
}

TEST_F(FairShareTest, EqualViewsAlternate) {
  for (const char* name : {"a", "b", "c", "d"}) workers_[name] = {.cost = 10ms};
  run_for(4s);
  for (const auto& [name, worker] : workers_) {
    EXPECT_EQ(worker.pieces, 100) << name;
    EXPECT_EQ(worker.longest_wait, 30ms) << name;
  }
}

TEST_F(FairShareTest, AFrameThatWasHeldUpDoesNotKeepItsViewWaiting) {
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) workers_[name] = {.cost = 10ms};
  run_for(4s);
  Worker& held_up = workers_["a"];
  held_up.cost = 1s;
  const int before = held_up.pieces;
  while (held_up.pieces == before) run_for(1ms);
  held_up.cost = 10ms;
  held_up.longest_wait = {};
  run_for(10s);
  EXPECT_LE(held_up.longest_wait, 200ms);
}

TEST_F(FairShareTest, ViewsThatBecomeExpensivePayForIt) {
  workers_["heavy"] = {.cost = 10ms};
  workers_["light"] = {.cost = 10ms};
  run_for(4s);
  workers_["heavy"].cost = 200ms;
  const auto before = workers_["light"].worked;
  run_for(20s);
  EXPECT_NEAR(static_cast<double>((workers_["light"].worked - before).count()), 10000.0, 700.0);
}

TEST_F(FairShareTest, LightLoadHasLowLatency) {
  workers_["greedy"] = {.cost = 50ms};
  workers_["modest"] = {.cost = 10ms, .interval = 100ms};
  run_for(10s);
  EXPECT_GE(workers_["modest"].pieces, 90);
  EXPECT_LE(workers_["modest"].longest_wait, 50ms) << "one greedy piece";
  EXPECT_GE(workers_["greedy"].worked, 8500ms) << "time that is not needed stays unused";
}

TEST_F(FairShareTest, IdleTimeGivesNoCredit) {
  workers_["busy"] = {.cost = 10ms};
  workers_["back"] = {.cost = 10ms, .ready = time_ + 10s};
  run_for(10s);
  const auto before = workers_["busy"].worked;
  run_for(1s);
  const auto gained = workers_["busy"].worked - before;
  EXPECT_NEAR(static_cast<double>(gained.count()), 500.0, 20.0) << "starved by a backlog";
}

TEST_F(FairShareTest, NewViewsStartWithTheOthers) {
  workers_["first"] = {.cost = 10ms};
  run_for(10s);
  workers_["second"] = {.cost = 10ms};
  const auto before = workers_["first"].worked;
  run_for(1s);
  EXPECT_NEAR(static_cast<double>((workers_["first"].worked - before).count()), 500.0, 20.0);
}

TEST_F(FairShareTest, AViewThatWasAwaitedWhenAllBecameIdlePaysForTheWaitOnly) {
  Worker& heavy = workers_["heavy"] = {.cost = 100ms};
  Worker& light = workers_["light"] = {.cost = 5ms, .pause = 3ms};
  run_for(2s);
  while (light.ready <= time_ || heavy.ready > time_ || choose()) run_for(1ms);
  // Nothing is to be drawn any more while the device waits for one of them.
  heavy.ready = light.ready = time_ + 10s;
  run_for(11s);
  const int before = light.pieces;
  run_for(2s);
  EXPECT_GE(light.pieces - before, 100) << "half of the time, one piece in 8 ms";
}

TEST_F(FairShareTest, ARemovedViewHasNoDebt) {
  const int key = 0;
  const int other = 0;
  share_.charge(&key, time_, time_ + 10s, 10s);
  share_.remove(&key);
  share_.charge(&other, time_ + 10s, time_ + 11s, 1s);
  std::vector<FairShare::Key> keys{&other, &key};
  share_.sort(keys);
  EXPECT_EQ(keys.front(), &key);
}

}  // namespace
}  // namespace heliograph::session
