#pragma once

#include <algorithm>
#include <atomic>
#include <cstring>
#include <span>

#include "gpu/frame_plan/bindings.hpp"
#include "render/kernels/common/parallel.hpp"
#include "shaders/shared/ray.h"

namespace heliograph::render::kernels {

/// Rays that a thread works on at a time.
inline constexpr int ray_batch = 256;

/// Calls `work(first, last)` for batches of `count` rays, on all processors.
inline void for_each_batch(int count, RangeWork work) {
  for_each_range(count, ray_batch, work);
}

/// The indirect dispatches that cover a stream, as shaders/lib/rays/ray_stream.glsl leaves them.
inline void set_groups(shared::RayCount& count) {
  const auto cover = [](std::uint32_t groups, std::uint32_t& x, std::uint32_t& y) {
    x = std::min(groups, shared::groups_per_row);
    y = std::max((groups + shared::groups_per_row - 1) / shared::groups_per_row, 1u);
  };
  cover((count.count + shared::rays_per_group - 1) / shared::rays_per_group, count.groups_x,
        count.groups_y);
  cover(shared::tracing_groups(count.count), count.tracing_groups_x, count.tracing_groups_y);
  count.groups_z = count.tracing_groups_z = 1;
}

/// Of a stream of so many rays. `blending`: see shared::RayCount.
inline shared::RayCount full_count(std::uint32_t rays, std::uint32_t blending) {
  shared::RayCount count{.count = rays, .blending = blending};
  set_groups(count);
  return count;
}

/// A stream of rays that a pass reads.
template <class Stage>
struct RaySource {
  gpu::ReadBuffer<Stage, shared::RayCount> count;
  gpu::ReadBuffer<Stage, shared::Ray> rays;
};

/// A stream that a pass appends to; what shaders/lib/rays/ray_stream.glsl does.
template <class Stage>
struct RaySink {
  gpu::ReadWriteBuffer<Stage, shared::RayCount> count;
  gpu::WriteBuffer<Stage, shared::Ray> rays;

  /// Thread safe.
  void append(std::span<const shared::Ray> added) const {
    const std::atomic_ref total(count->count);
    const std::uint32_t first = total.fetch_add(static_cast<std::uint32_t>(added.size()));
    std::memcpy(rays + first, added.data(), added.size_bytes());
  }
  /// After the last ray.
  void end() const { set_groups(*count); }
};

/// shaders/rays/rays_begin.comp
template <class Stage>
struct RaysBeginBindings {
  gpu::WriteBuffer<Stage, shared::RayCount> count;
};
struct RaysBeginConstants {
  std::uint32_t by_coverage;  // 1: blended surfaces stop a fraction of the rays, 0: all
};
using RaysBeginJob = gpu::HostPass<RaysBeginBindings, RaysBeginConstants>;

/// Empties a stream. `blending`: see shared::RayCount.
inline void rays_begin(const RaysBeginJob& job, std::uint32_t blending) {
  *job.count = full_count(0, blending);
}

}  // namespace heliograph::render::kernels
