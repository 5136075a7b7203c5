#include "session/rendering/retry_backoff.hpp"

#include <algorithm>

namespace heliograph::session {

Clock::duration RetryBackoff::after_loss(Clock::time_point now) {
  if (now >= recovered_at_ + stable_after && recovered_at_ != Clock::time_point{}) failures_ = 0;
  recovered_at_ = {};
  const int failures = failures_++;
  if (failures == 0) return {};
  const std::chrono::seconds delay{1 << std::min(failures - 1, 5)};
  return std::min<Clock::duration>(delay, max_delay);
}

}  // namespace heliograph::session
