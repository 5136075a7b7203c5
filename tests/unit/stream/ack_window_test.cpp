#include "stream/pacing/ack_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

namespace heliograph::stream {
namespace {

using std::chrono::duration_cast;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A link with a delay, on which frames arrive at least `service` apart; there is a new frame every
/// 16 ms, which is sent as soon as the window allows.
class AckWindowTest : public testing::Test {
 protected:
  /// Frames per second that arrive.
  double run_for(seconds duration) {
    const Clock::time_point end = now_ + duration;
    int arrived = 0;
    for (; now_ < end; now_ += milliseconds(1)) {
      while (!in_flight_.empty() && in_flight_.front().arrives <= now_) {
        const Frame frame = in_flight_.front();
        in_flight_.pop_front();
        newest_delay_ = duration_cast<microseconds>(now_ - frame.sent);
        window_.arrived({.delay = newest_delay_, .interval = interval_, .ahead = frame.ahead},
                        now_);
        ++arrived;
      }
      if (now_ < next_frame_ || in_flight_.size() >= window_.size()) continue;
      next_frame_ = now_ + interval_;
      free_at_ = std::max(free_at_, now_) + service_;
      in_flight_.push_back(
          {.sent = now_, .arrives = free_at_ + delay_, .ahead = in_flight_.size()});
    }
    return arrived / std::chrono::duration<double>(duration).count();
  }

  struct Frame {
    Clock::time_point sent;
    Clock::time_point arrives;
    std::size_t ahead;
  };
  AckWindow window_;
  std::deque<Frame> in_flight_;
  milliseconds interval_{16};
  milliseconds delay_{0};
  milliseconds service_{1};
  microseconds newest_delay_{0};
  Clock::time_point now_{std::chrono::hours(1)};
  Clock::time_point next_frame_;
  Clock::time_point free_at_;
};

TEST_F(AckWindowTest, IsTwoForShortRoundTrips) {
  delay_ = milliseconds(8);
  run_for(seconds(5));
  EXPECT_EQ(window_.size(), ack_window);
}

TEST_F(AckWindowTest, GrowsWithTheRoundTripUntilEveryFrameFits) {
  delay_ = milliseconds(100);
  EXPECT_LT(run_for(seconds(1)), 40.0);
  run_for(seconds(4));
  EXPECT_GT(run_for(seconds(5)), 58.0);
  EXPECT_LE(window_.size(), max_ack_window);
}

TEST_F(AckWindowTest, HasAMaximum) {
  delay_ = milliseconds(1000);
  run_for(seconds(60));
  EXPECT_EQ(window_.size(), max_ack_window);
}

TEST_F(AckWindowTest, StaysSmallForASlowViewer) {
  service_ = milliseconds(100);
  run_for(seconds(20));
  EXPECT_EQ(window_.size(), ack_window) << "frames would wait for each other";
}

TEST_F(AckWindowTest, MatchesTheCapacityOfALongAndSlowLink) {
  delay_ = milliseconds(100);
  service_ = milliseconds(50);
  run_for(seconds(10));
  EXPECT_GT(run_for(seconds(5)), 18.0) << "20 a second fit";
  EXPECT_LE(newest_delay_, milliseconds(240)) << "of 150 alone";
}

TEST_F(AckWindowTest, ShrinksWhenTheLinkBecomesSlow) {
  delay_ = milliseconds(100);
  run_for(seconds(5));
  service_ = milliseconds(100);
  run_for(seconds(10));
  EXPECT_LE(window_.size(), 3u);
  EXPECT_LE(newest_delay_, milliseconds(330));
}

TEST_F(AckWindowTest, DoesNotGrowAtLowFrameRates) {
  delay_ = milliseconds(100);
  interval_ = milliseconds(100);
  run_for(seconds(10));
  EXPECT_EQ(window_.size(), ack_window);
}

}  // namespace
}  // namespace heliograph::stream
