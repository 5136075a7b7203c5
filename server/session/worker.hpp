#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace heliograph::session {

/// Threads that run tasks, begun in order. An exception in a task is logged.
class Worker {
 public:
  /// At most `capacity` tasks are queued.
  Worker(std::string name, std::size_t capacity, std::size_t threads = 1);
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// False if the queue is full; then `task` was not taken.
  bool post(std::function<void()> task);
  bool has_room() const;
  /// Waits for the running tasks; queued ones are destroyed without running, later ones refused.
  void stop();

 private:
  void run();

  const std::string name_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable condition_;
  std::deque<std::function<void()>> queue_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace heliograph::session
