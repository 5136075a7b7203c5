#include "jobs/pauses.hpp"

#include <gtest/gtest.h>

namespace heliograph::jobs {
namespace {

using namespace std::chrono_literals;

constexpr auto step = 100ms;

/// The share of a time in which images move that the renderer runs for.
double running_share(std::chrono::seconds time) {
  Pauses::Clock::time_point now{};
  Pauses pauses(now);
  int running = 0;
  const int steps = static_cast<int>(time / step);
  for (int i = 0; i < steps; ++i, now += step) running += pauses.update(now, true) ? 0 : 1;
  return static_cast<double>(running) / steps;
}

TEST(Pauses, ARendererRunsWhileNothingMoves) {
  Pauses::Clock::time_point now{};
  Pauses pauses(now);
  for (int i = 0; i < 1000; ++i, now += step) EXPECT_FALSE(pauses.update(now, false));
  EXPECT_TRUE(pauses.update(now, true));
  EXPECT_FALSE(pauses.update(now + step, false));
}

TEST(Pauses, ImagesThatMoveAllTheTimeDelayARendererButNotWithoutEnd) {
  EXPECT_EQ(running_share(Pauses::longest), 0.0);
  // The 95th percentile of frame times is one beside which nothing is rendered.
  EXPECT_GT(running_share(1000s), 0.03);
  EXPECT_LT(running_share(1000s), 0.05);
}

}  // namespace
}  // namespace heliograph::jobs
