#include "stream/pacing/ack_window.hpp"

#include <algorithm>
#include <cmath>

namespace heliograph::stream {
namespace {

using std::chrono::milliseconds;

/// Later than this part of the time alone, and then some for the noise of short ways: frames wait
/// for each other.
constexpr double in_time = 1.25;
constexpr double late = 1.5;
constexpr double noise = 5'000.0;  // microseconds
constexpr int arrivals_to_grow = 6;
constexpr int arrivals_to_shrink = 3;
/// After the window was too large.
constexpr milliseconds before_growing{3000};
constexpr double newest_delay_weight = 0.25;

}  // namespace

void AckWindow::arrived(const Arrival& arrival, Clock::time_point now) {
  const double delay = static_cast<double>(arrival.delay.count());
  // Nothing is faster than the way, and only a frame alone on it shows that it has become slower.
  if (alone_ == 0.0 || delay < alone_) alone_ = delay;
  if (arrival.ahead == 0) alone_ += newest_delay_weight * (delay - alone_);

  late_ = delay > late * alone_ + noise ? late_ + 1 : 0;
  if (late_ >= arrivals_to_shrink && size_ > ack_window) {
    --size_;
    // What is on the way now was sent before.
    late_ = -static_cast<int>(size_);
    in_time_ = 0;
    may_grow_at_ = now + before_growing;
    return;
  }
  const double interval = std::max(1.0, static_cast<double>(arrival.interval.count()));
  const double wanted = std::round(alone_ / interval) + 1.0;
  const bool filled = arrival.ahead + 1 >= size_;
  const bool timely = delay <= in_time * alone_ + noise;
  if (!timely) {
    in_time_ = 0;
  } else if (filled) {
    ++in_time_;
  }
  if (in_time_ < arrivals_to_grow || now < may_grow_at_) return;
  if (static_cast<double>(size_) < wanted && size_ < longest_ack_window) ++size_;
  in_time_ = 0;
}

}  // namespace heliograph::stream
