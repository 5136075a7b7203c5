#include "render/kernels/signals.hpp"

#include <cmath>

#include "render/kernels/simd/rows.hpp"

namespace heliograph::render::kernels {
namespace {

/// Numbers that are none must not spread through filters and histories.
float sanitize(float value) {
  return std::isfinite(value) ? value : 0.0f;
}

}  // namespace

void visibility_combine(const CombineJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const auto row = static_cast<std::uint32_t>(y);
      const float* const shadows = job.shadows.row<const float>(row);
      const float* const ambient = job.ambient.row<const float>(row);
      float* to = job.visibility.row<float>(row);
      for (int x = 0; x < job.width; ++x, to += 4) {
        to[0] = sanitize(shadows[x]);
        to[1] = sanitize(ambient[x]);
        to[2] = to[3] = 0.0f;
      }
    }
  });
}

void accumulate(const AccumulateJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const auto row = static_cast<std::uint32_t>(y);
      const float* const sample = job.sample.row<const float>(row);
      const float* const previous = job.previous.row<const float>(row);
      float* const mean = job.mean.row<float>(row);
      if (job.constants.weight >= 1.0f) {
        std::copy_n(sample, 4 * job.width, mean);
        continue;
      }
      for (int i = 0; i < 4 * job.width; ++i) {
        mean[i] = previous[i] + (sample[i] - previous[i]) * job.constants.weight;
      }
    }
  });
}

void visibility_resolve(const VisibilityResolveJob& job) {
  constexpr int grain = 4096;
  for_each_range(static_cast<int>(job.rays.count->count), grain, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      if (job.occluded[i] == 0) continue;
      const std::uint32_t pixel = job.rays.rays[i].pixel;
      job.visibility.row<float>(pixel >> 16u)[pixel & 0xffffu] = 0.0f;
    }
  });
}

}  // namespace heliograph::render::kernels
