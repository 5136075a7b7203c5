#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <stop_token>
#include <thread>
#include <utility>

#include "scene/import_error.hpp"

namespace heliograph::scene {

/// Counts finished parts of several threads and reports progress on the thread that created it. An
/// exception of the callback is rethrown on all threads.
class PartsDone {
 public:
  PartsDone(std::function<void(float fraction)> tell, std::size_t parts,
            const std::stop_token& stop)
      : tell_(std::move(tell)), parts_(parts), stop_(stop) {}

  void add_one() {
    throw_if_cancelled(stop_);
    const std::size_t done = ++done_;
    if (stopped_) std::rethrow_exception(reason_);
    if (std::this_thread::get_id() != home_) return;
    try {
      tell_(float(done) / float(parts_));
    } catch (...) {
      reason_ = std::current_exception();
      stopped_ = true;
      throw;
    }
  }

 private:
  const std::function<void(float fraction)> tell_;
  const std::size_t parts_;
  const std::stop_token& stop_;
  const std::thread::id home_ = std::this_thread::get_id();
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
  std::exception_ptr reason_;  // set by the first exception
};

}  // namespace heliograph::scene
