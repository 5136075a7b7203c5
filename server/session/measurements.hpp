#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "protocol/messages/messages.hpp"
#include "render/api/frame_values.hpp"
#include "stream/pacing/histogram.hpp"

namespace heliograph::session {

struct RenderTotals {
  using Pass = std::pair<std::string, protocol::PassKind>;

  stream::Histogram frames;  // seconds each
  stream::Histogram encodings;
  std::map<protocol::PassKind, std::uint64_t> encoded_by;
  stream::Histogram captures;  // from the request to the file
  std::uint64_t failed_captures = 0;
  std::map<Pass, stream::Histogram> by_pass;
  std::vector<protocol::PassTiming> passes;  // of the latest frame
  render::CacheUse radiance_cache;           // of the same
};

/// Totals of the time of rendering, encoding and captures, for metrics. Thread safe.
class Measurements {
 public:
  void rendered(double seconds, std::vector<protocol::PassTiming> passes,
                const render::CacheUse& radiance_cache) {
    const std::lock_guard lock(mutex_);
    totals_.frames.add(seconds);
    for (const protocol::PassTiming& pass : passes) {
      totals_.by_pass[{pass.name, pass.kind}].add(pass.ms / 1000.0);
    }
    totals_.passes = std::move(passes);
    totals_.radiance_cache = radiance_cache;
  }
  void encoded(double seconds, protocol::PassKind by) {
    const std::lock_guard lock(mutex_);
    totals_.encodings.add(seconds);
    ++totals_.encoded_by[by];
  }
  void captured(double seconds) {
    const std::lock_guard lock(mutex_);
    totals_.captures.add(seconds);
  }
  void capture_failed() {
    const std::lock_guard lock(mutex_);
    ++totals_.failed_captures;
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
