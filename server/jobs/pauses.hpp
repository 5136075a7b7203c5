#pragma once

#include <chrono>

namespace heliograph::jobs {

/// When the renderer of a job is paused: while a session's image moves, whose frames would take
/// longer beside it. Sessions that move all the time delay jobs, but not without end.
class Pauses {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds longest{24};
  /// After the longest pause. Less than one in twenty frames is drawn beside it.
  static constexpr std::chrono::seconds turn{1};

  explicit Pauses(Clock::time_point begin) : last_run_(begin), turn_until_(begin) {}

  /// Whether it is paused from now on; to be asked several times a second.
  bool update(Clock::time_point now, bool moving) {
    const bool late = now >= last_run_ + longest;
    if (moving && late) turn_until_ = now + turn;
    if (moving && !late && now >= turn_until_) return true;
    last_run_ = now;
    return false;
  }

 private:
  Clock::time_point last_run_;
  Clock::time_point turn_until_;
};

}  // namespace heliograph::jobs
