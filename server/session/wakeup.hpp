#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>

#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// Lets one thread sleep until another has something for it. A notification that comes before the
/// wait ends the wait at once.
class Wakeup {
 public:
  void notify();
  /// Returns after a notification or at `deadline`, whichever is first.
  void wait_until(std::optional<Clock::time_point> deadline);

 private:
  std::mutex mutex_;
  std::condition_variable condition_;
  bool notified_ = false;
};

}  // namespace heliograph::session
