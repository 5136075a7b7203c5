#pragma once

#include <atomic>
#include <exception>

namespace heliograph::scene {

/// Passes the first exception of parallel tasks around oneTBB: in version 2021.8 an exception that
/// leaves a nested task makes it access task groups that may be destroyed.
class FirstFailure {
 public:
  /// Runs `task` unless another task has failed.
  template <typename Task>
  void guard(const Task& task) noexcept {
    if (failed_) return;
    try {
      task();
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
    }
  }

  /// Rethrows the first exception after all tasks are done.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
};

}  // namespace heliograph::scene
