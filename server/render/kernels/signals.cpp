#include "render/kernels/signals.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "render/kernels/simd/rows.hpp"

namespace heliograph::render::kernels {
namespace {

/// Numbers that are none must not spread through filters and histories.
float sanitize(float value) {
  return std::isfinite(value) ? value : 0.0f;
}

void start_mean(const float* sample, int width, float* mean) {
  std::copy_n(sample, 4 * width, mean);
  for (int x = 0; x < width; ++x) mean[4 * x + 3] = 0.0f;
}

float luminance_of(const float* color) {
  return 0.2126f * color[0] + (0.7152f * color[1] + 0.0722f * color[2]);
}

void add_to_mean(const float* sample, const float* previous, int width, float weight, float* mean) {
  const auto mixed = [weight](float a, float b) { return a + (b - a) * weight; };
  for (int i = 0; i < 4 * width; i += 4) {
    for (int c = i; c < i + 3; ++c) mean[c] = mixed(previous[c], sample[c]);
    const float light = luminance_of(sample + i);
    const float product = (light - luminance_of(previous + i)) * (light - luminance_of(mean + i));
    mean[i + 3] = mixed(previous[i + 3], product);
  }
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
        start_mean(sample, job.width, mean);
      } else {
        add_to_mean(sample, previous, job.width, job.constants.weight, mean);
      }
    }
  });
}

void hold_mean(const HoldMeanJob& job) {
  for_each_band(static_cast<int>(job.constants.shown.y), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const auto row = static_cast<std::uint32_t>(y);
      const auto* mean = job.mean.row<const std::uint32_t>(row);
      const float* const weights = job.mean_weight.row<const float>(row);
      const float uniform = job.constants.weight;
      float* color = job.resolved.row<float>(row);
      for (std::uint32_t x = 0; x < job.constants.shown.x; ++x, mean += 2, color += 4) {
        const glm::vec2 first_two = glm::unpackHalf2x16(mean[0]);
        const glm::vec3 kept(first_two, glm::unpackHalf2x16(mean[1]).x);
        const float weight = uniform < 0.0f ? weights[x] : uniform;
        for (int c = 0; c < 3; ++c) color[c] += (kept[c] - color[c]) * weight;
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
