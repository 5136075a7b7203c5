#pragma once

#include <chrono>

namespace heliograph::net {

/// A token bucket: `rate` calls a second in the long run, `burst` at once.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  RateLimit(double rate, double burst, Clock::time_point now);
  /// Whether one more call is within the limit; then it counts.
  bool allow(Clock::time_point now);

 private:
  double rate_;
  double burst_;
  double available_;
  Clock::time_point last_;
};

}  // namespace heliograph::net
