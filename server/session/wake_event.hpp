#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// Auto-reset event for one waiting thread. A notification before the wait ends the wait at once.
class WakeEvent {
 public:
  /// `parent`, if any, is notified with this one: a thread may wait for many events.
  explicit WakeEvent(std::shared_ptr<WakeEvent> parent = nullptr) : parent_(std::move(parent)) {}

  void notify();
  /// Whether there was a notification since the last `take` or wait.
  bool is_notified() const;
  /// Resets it; gives whether there was a notification.
  bool take();
  /// Returns after a notification or at `deadline`, whichever is first.
  void wait_until(std::optional<Clock::time_point> deadline);

 private:
  const std::shared_ptr<WakeEvent> parent_;
  mutable std::mutex mutex_;
  std::condition_variable condition_;
  bool notified_ = false;
};

}  // namespace heliograph::session
