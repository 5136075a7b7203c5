#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <span>

#include "shaders/shared/ray.h"

namespace heliograph::render::host {

/// Rays that a thread works on at a time.
inline constexpr int ray_batch = 256;

/// Calls `work(first, last)` for batches of `count` rays, on all processors.
template <class Work>
void for_each_batch(int count, const Work& work) {
  const int batches = (count + ray_batch - 1) / ray_batch;
  tbb::parallel_for(tbb::blocked_range<int>(0, batches), [&](const auto& some) {
    for (int batch = some.begin(); batch < some.end(); ++batch) {
      work(batch * ray_batch, std::min((batch + 1) * ray_batch, count));
    }
  });
}

/// A stream of rays that kernels read.
struct RaySource {
  const shared::RayCount* count;
  const shared::Ray* rays;
};

/// A stream that all threads append to; what shaders/lib/ray_stream.glsl does.
class RaySink {
 public:
  RaySink(shared::RayCount* count, shared::Ray* rays) : count_(count), rays_(rays) {}

  /// Before the first ray.
  void begin() const { *count_ = {0, 0, 1, 1}; }
  /// Thread safe.
  void append(std::span<const shared::Ray> rays) const {
    const std::atomic_ref count(count_->count);
    const std::uint32_t first = count.fetch_add(static_cast<std::uint32_t>(rays.size()));
    std::memcpy(rays_ + first, rays.data(), rays.size_bytes());
  }
  /// After the last: as many groups of 64 as tracing on the device wants.
  void end() const { count_->groups_x = (count_->count + 63) / 64; }

 private:
  shared::RayCount* count_;
  shared::Ray* rays_;
};

}  // namespace heliograph::render::host
