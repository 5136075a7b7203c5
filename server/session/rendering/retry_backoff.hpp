#pragma once

#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// The delay before a lost device is recreated: none at first, then doubled with each loss until
/// the device is stable. Pure logic.
class RetryBackoff {
 public:
  /// The device was lost, or could not be recreated: gives the delay until the next try.
  Clock::duration after_loss(Clock::time_point now);
  /// It was recreated; it counts as stable after `stable_after`.
  void recovered(Clock::time_point now) { recovered_at_ = now; }

 private:
  static constexpr std::chrono::seconds stable_after{10};
  static constexpr std::chrono::seconds max_delay{30};

  Clock::time_point recovered_at_{};
  int failures_ = 0;
};

}  // namespace heliograph::session
