#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "stream/encoded_frame.hpp"

namespace heliograph::session {

using stream::Clock;

/// Lets one thread sleep until another has something for it. A notification that comes before the
/// wait ends the wait at once.
class WakeEvent {
 public:
  /// `all`, if any, is notified with this one: it stands for many such sources.
  explicit WakeEvent(std::shared_ptr<WakeEvent> all = nullptr) : all_(std::move(all)) {}

  void notify();
  /// Whether there was a notification since the last `take` or wait.
  bool is_notified() const;
  bool take();
  /// Returns after a notification or at `deadline`, whichever is first.
  void wait_until(std::optional<Clock::time_point> deadline);

 private:
  const std::shared_ptr<WakeEvent> all_;
  mutable std::mutex mutex_;
  std::condition_variable condition_;
  bool notified_ = false;
};

}  // namespace heliograph::session
