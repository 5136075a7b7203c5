#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>

namespace heliograph::gpu {

/// A mutex for two kinds of work: lock_first() waits at most for the one that holds it,
/// lock_after() for all that wait in lock_first(), too.
class PriorityMutex {
 public:
  std::unique_lock<std::mutex> lock_first() {
    ++first_waiting_;
    std::unique_lock lock(mutex_);
    if (--first_waiting_ == 0) none_waits_.notify_all();
    return lock;
  }

  std::unique_lock<std::mutex> lock_after() {
    std::unique_lock lock(mutex_);
    none_waits_.wait(lock, [this] { return first_waiting_ == 0; });
    return lock;
  }

 private:
  std::mutex mutex_;
  std::condition_variable none_waits_;
  std::atomic<int> first_waiting_ = 0;
};

}  // namespace heliograph::gpu
