#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace heliograph::session {

/// One thread that carries out tasks in order. An exception in a task is logged.
class Worker {
 public:
  /// At most `capacity` tasks wait.
  Worker(std::string name, std::size_t capacity);
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// False if no more tasks can wait; then `task` was not taken.
  bool post(std::function<void()> task);
  bool has_room() const;
  /// Waits for the running task; waiting ones are destroyed undone, later ones are not taken.
  void stop();

 private:
  void run();

  const std::string name_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable condition_;
  std::deque<std::function<void()>> waiting_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace heliograph::session
