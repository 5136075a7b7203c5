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

/// A way with a delay, on which frames follow each other no closer than `service`; pictures are
/// there every 16 ms, and each is sent as soon as the window lets it.
class AckWindowTest : public testing::Test {
 protected:
  /// Frames a second that arrive.
  double run_for(seconds duration) {
    const Clock::time_point end = now_ + duration;
    int arrived = 0;
    for (; now_ < end; now_ += milliseconds(1)) {
      while (!on_the_way_.empty() && on_the_way_.front().arrives <= now_) {
        const Frame frame = on_the_way_.front();
        on_the_way_.pop_front();
        newest_delay_ = duration_cast<microseconds>(now_ - frame.sent);
        window_.arrived({.delay = newest_delay_, .interval = interval_, .ahead = frame.ahead},
                        now_);
        ++arrived;
      }
      if (now_ < next_picture_ || on_the_way_.size() >= window_.size()) continue;
      next_picture_ = now_ + interval_;
      free_at_ = std::max(free_at_, now_) + service_;
      on_the_way_.push_back(
          {.sent = now_, .arrives = free_at_ + delay_, .ahead = on_the_way_.size()});
    }
    return arrived / std::chrono::duration<double>(duration).count();
  }

  struct Frame {
    Clock::time_point sent;
    Clock::time_point arrives;
    std::size_t ahead;
  };
  AckWindow window_;
  std::deque<Frame> on_the_way_;
  milliseconds interval_{16};
  milliseconds delay_{0};
  milliseconds service_{1};
  microseconds newest_delay_{0};
  Clock::time_point now_{std::chrono::hours(1)};
  Clock::time_point next_picture_;
  Clock::time_point free_at_;
};

TEST_F(AckWindowTest, IsTwoOnAShortWay) {
  delay_ = milliseconds(8);
  run_for(seconds(5));
  EXPECT_EQ(window_.size(), ack_window);
}

TEST_F(AckWindowTest, OpensOnALongWayUntilEveryPictureFits) {
  delay_ = milliseconds(100);
  EXPECT_LT(run_for(seconds(1)), 40.0);
  run_for(seconds(4));
  EXPECT_GT(run_for(seconds(5)), 58.0);
  EXPECT_LE(window_.size(), longest_ack_window);
}

TEST_F(AckWindowTest, HasAnEnd) {
  delay_ = milliseconds(1000);
  run_for(seconds(60));
  EXPECT_EQ(window_.size(), longest_ack_window);
}

TEST_F(AckWindowTest, StaysSmallBeforeASlowViewer) {
  service_ = milliseconds(100);
  run_for(seconds(20));
  EXPECT_EQ(window_.size(), ack_window) << "frames would wait for each other";
}

TEST_F(AckWindowTest, HoldsWhatALongAndNarrowWayDoes) {
  delay_ = milliseconds(100);
  service_ = milliseconds(50);
  run_for(seconds(10));
  EXPECT_GT(run_for(seconds(5)), 18.0) << "20 a second fit";
  EXPECT_LE(newest_delay_, milliseconds(240)) << "of 150 alone";
}

TEST_F(AckWindowTest, ClosesWhenTheWayBecomesNarrow) {
  delay_ = milliseconds(100);
  run_for(seconds(5));
  service_ = milliseconds(100);
  run_for(seconds(10));
  EXPECT_LE(window_.size(), 3u);
  EXPECT_LE(newest_delay_, milliseconds(330));
}

TEST_F(AckWindowTest, DoesNotOpenForPicturesThatAreSeldom) {
  delay_ = milliseconds(100);
  interval_ = milliseconds(100);
  run_for(seconds(10));
  EXPECT_EQ(window_.size(), ack_window);
}

}  // namespace
}  // namespace heliograph::stream
