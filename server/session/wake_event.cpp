#include "session/wake_event.hpp"

#include <utility>

namespace heliograph::session {

void WakeEvent::notify() {
  {
    const std::lock_guard lock(mutex_);
    notified_ = true;
  }
  condition_.notify_one();
  if (parent_) parent_->notify();
}

bool WakeEvent::is_notified() const {
  const std::lock_guard lock(mutex_);
  return notified_;
}

bool WakeEvent::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(notified_, false);
}

void WakeEvent::wait_until(std::optional<Clock::time_point> deadline) {
  std::unique_lock lock(mutex_);
  const auto notified = [&] { return notified_; };
  if (deadline) {
    condition_.wait_until(lock, *deadline, notified);
  } else {
    condition_.wait(lock, notified);
  }
  notified_ = false;
}

}  // namespace heliograph::session
