#include "session/worker.hpp"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

namespace heliograph::session {

Worker::Worker(std::string name, std::size_t capacity, std::size_t threads)
    : name_(std::move(name)), capacity_(capacity) {
  try {
    threads_.reserve(threads);
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
  } catch (...) {
    stop();  // those that have started
    throw;
  }
}

void Worker::stop() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(stopping_, true)) return;
  }
  condition_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  queue_.clear();
}

bool Worker::post(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_ || queue_.size() >= capacity_) return false;
    queue_.push_back(std::move(task));
  }
  condition_.notify_one();
  return true;
}

bool Worker::has_room() const {
  const std::lock_guard lock(mutex_);
  return queue_.size() < capacity_;
}

void Worker::run() {
  while (true) {
    std::function<void()> task;
    {
      std::unique_lock lock(mutex_);
      condition_.wait(lock, [&] { return stopping_ || !queue_.empty(); });
      if (stopping_) return;
      task = std::move(queue_.front());
      queue_.pop_front();
    }
    try {
      task();
    } catch (const std::exception& failure) {
      spdlog::error("{}: {}", name_, failure.what());
    }
  }
}

}  // namespace heliograph::session
