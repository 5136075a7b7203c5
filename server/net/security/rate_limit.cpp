#include "net/security/rate_limit.hpp"

#include <algorithm>

namespace heliograph::net {

RateLimit::RateLimit(double rate, double burst, Clock::time_point now)
    : rate_(rate), burst_(burst), available_(burst), last_(now) {}

bool RateLimit::allow(Clock::time_point now) {
  const std::chrono::duration<double> elapsed = now - last_;
  last_ = now;
  available_ = std::min(burst_, available_ + rate_ * elapsed.count());
  if (available_ < 1.0) return false;
  available_ -= 1.0;
  return true;
}

}  // namespace heliograph::net
