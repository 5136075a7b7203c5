#include "session/rendering/retry_backoff.hpp"

#include <gtest/gtest.h>

namespace heliograph::session {
namespace {

using namespace std::chrono_literals;

const Clock::time_point start{1h};

TEST(RetryBackoff, TheFirstLossIsMendedAtOnce) {
  RetryBackoff pause;
  EXPECT_EQ(pause.after_loss(start), 0s);
}

TEST(RetryBackoff, RepeatedLossesWaitLongerEachTime) {
  RetryBackoff pause;
  Clock::time_point now = start;
  std::vector<Clock::duration> waits;
  for (int i = 0; i < 9; ++i) {
    waits.push_back(pause.after_loss(now));
    now += waits.back();
    pause.recovered(now);
    now += 1s;
  }
  EXPECT_EQ(waits, (std::vector<Clock::duration>{0s, 1s, 2s, 4s, 8s, 16s, 30s, 30s, 30s}));
}

TEST(RetryBackoff, ADeviceThatCannotBeMadeIsWaitedForToo) {
  RetryBackoff pause;
  EXPECT_EQ(pause.after_loss(start), 0s);
  EXPECT_EQ(pause.after_loss(start), 1s);
  EXPECT_EQ(pause.after_loss(start + 1h), 2s) << "it was never recovered";
}

TEST(RetryBackoff, ADeviceThatLastsIsHealthyAgain) {
  RetryBackoff pause;
  (void)pause.after_loss(start);
  (void)pause.after_loss(start);
  pause.recovered(start);
  EXPECT_EQ(pause.after_loss(start + 11s), 0s);
}

}  // namespace
}  // namespace heliograph::session
