#pragma once

#include <chrono>
#include <string>

namespace heliograph::session {

/// The position of a session's animation clip, as a function of time.
struct AnimationClock {
  using Clock = std::chrono::steady_clock;

  std::string clip;      // empty: no animation
  double seconds = 0.0;  // position at `since`
  double rate = 1.0;     // clip seconds per second
  bool playing = false;
  Clock::time_point since;

  bool operator==(const AnimationClock&) const = default;

  double at(Clock::time_point now) const {
    if (!playing) return seconds;
    return seconds + rate * std::chrono::duration<double>(now - since).count();
  }
};

}  // namespace heliograph::session
