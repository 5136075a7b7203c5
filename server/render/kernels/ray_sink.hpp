#pragma once

#include <algorithm>
#include <atomic>
#include <cstring>
#include <span>

#include "render/kernels/parallel.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::render::kernels {

/// Rays that a thread works on at a time.
inline constexpr int ray_batch = 256;

/// Calls `work(first, last)` for batches of `count` rays, on all processors.
inline void for_each_batch(int count, RangeWork work) {
  for_each_range(count, ray_batch, work);
}

/// The indirect dispatch that covers a stream, as shaders/lib/rays/ray_stream.glsl leaves it.
inline void set_groups(shared::RayCount& count) {
  const std::uint32_t groups = (count.count + shared::rays_per_group - 1) / shared::rays_per_group;
  count.groups_x = std::min(groups, shared::groups_per_row);
  count.groups_y = std::max((groups + shared::groups_per_row - 1) / shared::groups_per_row, 1u);
}

/// A stream of rays that kernels read.
struct RaySource {
  const shared::RayCount* count;
  const shared::Ray* rays;
};

/// A stream that all threads append to; what shaders/lib/rays/ray_stream.glsl does.
class RaySink {
 public:
  /// `blending`: see shared::RayCount.
  RaySink(shared::RayCount* count, shared::Ray* rays, std::uint32_t blending)
      : count_(count), rays_(rays), blending_(blending) {}

  /// Before the first ray.
  void begin() const { *count_ = {0, 0, 1, 1, blending_, 0, 0, 0}; }
  /// Thread safe.
  void append(std::span<const shared::Ray> rays) const {
    const std::atomic_ref count(count_->count);
    const std::uint32_t first = count.fetch_add(static_cast<std::uint32_t>(rays.size()));
    std::memcpy(rays_ + first, rays.data(), rays.size_bytes());
  }
  /// After the last.
  void end() const { set_groups(*count_); }

 private:
  shared::RayCount* count_;
  shared::Ray* rays_;
  std::uint32_t blending_;
};

}  // namespace heliograph::render::kernels
