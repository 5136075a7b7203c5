#include "stream/pacing/ack_window.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::stream {
namespace {

using std::chrono::milliseconds;

/// Factors on the delay of a frame alone in flight, plus `noise` for short round trips: a frame
/// below the first is in time, one above the second has queued behind others.
constexpr double in_time = 1.25;
constexpr double late = 1.5;
constexpr double noise = 5'000.0;  // microseconds
constexpr int arrivals_to_grow = 6;
constexpr int arrivals_to_shrink = 3;
/// Waiting time after the window was too large.
constexpr milliseconds before_growing{3000};
constexpr double newest_delay_weight = 0.25;

}  // namespace

void AckWindow::arrived(const Arrival& arrival, Clock::time_point now) {
  const double delay = static_cast<double>(arrival.delay.count());
  // The link is at least this fast; only a frame alone in flight shows that it became slower.
  if (unqueued_delay_ == 0.0 || delay < unqueued_delay_) unqueued_delay_ = delay;
  if (arrival.ahead == 0) unqueued_delay_ += newest_delay_weight * (delay - unqueued_delay_);

  late_ = delay > late * unqueued_delay_ + noise ? late_ + 1 : 0;
  if (late_ >= arrivals_to_shrink && size_ > ack_window) {
    --size_;
    // Frames in flight now were sent with the larger window.
    late_ = -static_cast<int>(size_);
    in_time_ = 0;
    may_grow_at_ = now + before_growing;
    return;
  }
  const double interval = std::max(1.0, static_cast<double>(arrival.interval.count()));
  const double target = std::round(unqueued_delay_ / interval) + 1.0;
  const bool filled = arrival.ahead + 1 >= size_;
  const bool timely = delay <= in_time * unqueued_delay_ + noise;
  if (!timely) {
    in_time_ = 0;
  } else if (filled) {
    ++in_time_;
  }
  if (in_time_ < arrivals_to_grow || now < may_grow_at_) return;
  if (static_cast<double>(size_) < target && size_ < max_ack_window) ++size_;
  in_time_ = 0;
}

}  // namespace heliograph::stream
