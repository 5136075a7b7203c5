#include "net/websocket/liveness.hpp"

#include <utility>

namespace heliograph::net {

Liveness::Liveness(std::chrono::milliseconds timeout, double min_rate,
                   std::chrono::milliseconds interval, Clock::time_point now)
    : timeout_(timeout), min_rate_(min_rate), interval_(interval), received_(now) {}

Liveness::Verdict Liveness::check(Clock::time_point now, std::uint64_t write,
                                  std::uint64_t acknowledged) {
  const bool same_message = std::exchange(write_, write) == write && write != 0;
  if (!same_message) {
    acknowledged_ = acknowledged;
  } else {
    const std::chrono::duration<double> silence = now - received_;
    if (static_cast<double>(acknowledged - acknowledged_) >= min_rate_ * silence.count()) {
      received_ = now;
      acknowledged_ = acknowledged;
    }
  }
  const Clock::duration silence = now - received_;
  if (silence > timeout_) return Verdict::lost;
  // The next check would be too late for a ping at half of the timeout.
  return silence > timeout_ / 2 - interval_ ? Verdict::silent : Verdict::alive;
}

}  // namespace heliograph::net
