#include "session/rendering/retry_backoff.hpp"

#include <gtest/gtest.h>

namespace heliograph::session {
namespace {

using namespace std::chrono_literals;

const Clock::time_point start{1h};

TEST(RetryBackoff, TheFirstRetryIsImmediate) {
  RetryBackoff backoff;
  EXPECT_EQ(backoff.after_loss(start), 0s);
}

TEST(RetryBackoff, RepeatedLossesDoubleTheDelay) {
  RetryBackoff backoff;
  Clock::time_point now = start;
  std::vector<Clock::duration> waits;
  for (int i = 0; i < 9; ++i) {
    waits.push_back(backoff.after_loss(now));
    now += waits.back();
    backoff.recovered(now);
    now += 1s;
  }
  EXPECT_EQ(waits, (std::vector<Clock::duration>{0s, 1s, 2s, 4s, 8s, 16s, 30s, 30s, 30s}));
}

TEST(RetryBackoff, FailedRecoveriesDoubleTheDelay) {
  RetryBackoff backoff;
  EXPECT_EQ(backoff.after_loss(start), 0s);
  EXPECT_EQ(backoff.after_loss(start), 1s);
  EXPECT_EQ(backoff.after_loss(start + 1h), 2s) << "it was never recovered";
}

TEST(RetryBackoff, AStableDeviceResetsTheDelay) {
  RetryBackoff backoff;
  (void)backoff.after_loss(start);
  (void)backoff.after_loss(start);
  backoff.recovered(start);
  EXPECT_EQ(backoff.after_loss(start + 11s), 0s);
}

}  // namespace
}  // namespace heliograph::session
