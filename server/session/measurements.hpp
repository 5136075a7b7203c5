#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "protocol/messages.hpp"

namespace heliograph::session {

struct RenderTotals {
  std::uint64_t frames = 0;
  double render_seconds = 0.0;
  std::uint64_t encodings = 0;
  double encode_seconds = 0.0;
  std::vector<protocol::PassTiming> passes;  // of the latest frame
};

/// Counts what rendering and encoding cost, for metrics. Thread safe.
class Measurements {
 public:
  void rendered(double seconds, std::vector<protocol::PassTiming> passes) {
    const std::lock_guard lock(mutex_);
    ++totals_.frames;
    totals_.render_seconds += seconds;
    totals_.passes = std::move(passes);
  }
  void encoded(double seconds) {
    const std::lock_guard lock(mutex_);
    ++totals_.encodings;
    totals_.encode_seconds += seconds;
  }
  RenderTotals totals() const {
    const std::lock_guard lock(mutex_);
    return totals_;
  }

 private:
  mutable std::mutex mutex_;
  RenderTotals totals_;
};

}  // namespace heliograph::session
