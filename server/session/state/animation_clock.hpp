#pragma once

#include <chrono>
#include <string>

namespace heliograph::session {

/// Where a session's clip stands, as long as nobody says otherwise.
struct AnimationClock {
  using Clock = std::chrono::steady_clock;

  std::string clip;      // empty: the scene rests
  double seconds = 0.0;  // at `since`
  double rate = 1.0;
  bool playing = false;
  Clock::time_point since;

  double at(Clock::time_point now) const {
    if (!playing) return seconds;
    return seconds + rate * std::chrono::duration<double>(now - since).count();
  }
};

}  // namespace heliograph::session
