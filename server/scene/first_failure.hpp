#pragma once

#include <atomic>
#include <exception>

namespace heliograph::scene {

/// Carries the first exception of tasks that run side by side past the library that runs them: when
/// one leaves a nested task, oneTBB 2021.8 walks through lists of task groups that may be gone.
class FirstFailure {
 public:
  /// Runs `task` unless something has failed before.
  template <typename Task>
  void guard(const Task& task) noexcept {
    if (failed_) return;
    try {
      task();
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
    }
  }

  /// Throws what was caught, once all tasks are done.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
};

}  // namespace heliograph::scene
