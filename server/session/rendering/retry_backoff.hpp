#pragma once

#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// How long to wait before a lost device is made anew: not at all at first, then longer each time
/// as long as it does not last. Pure logic.
class RetryBackoff {
 public:
  /// The device was lost, or could not be made: the time to wait now.
  Clock::duration after_loss(Clock::time_point now);
  /// It was made anew; one that then lasts for a while is healthy.
  void recovered(Clock::time_point now) { recovered_at_ = now; }

 private:
  static constexpr std::chrono::seconds healthy_after{10};
  static constexpr std::chrono::seconds longest{30};

  Clock::time_point recovered_at_{};
  int failures_ = 0;
};

}  // namespace heliograph::session
