#include "render/kernels/post/exposure.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <span>

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/post/exposure.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

using Bins = std::array<std::uint32_t, shared::exposure_bins>;

template <class D>
class Metering {
  using V = hn::Vec<D>;

 public:
  HWY_INLINE Metering(const ExposureMeterJob& job, Bins& bins) : job_(job), bins_(bins) {}

  /// Every second of the rows, of which the first is even.
  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; y += 2) {
      int done = 0;
      for (int x = 0; x < job_.width; x += lanes) {
        block(std::min(x, job_.width - lanes), y, done);
        done = x + lanes;
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  HWY_INLINE Triple<V> color(const gpu::HostView& image, int x, int y) const {
    const Quad<V> t = load4(d_, row_of<const float>(image, y) + 4 * x);
    return {t.x, t.y, t.z};
  }

  /// The pixels from `start` on; those before are counted.
  HWY_INLINE void block(int x, int y, int start) const {
    const float weight = job_.constants.mean_weight;
    const V zero = hn::Zero(d_);
    Triple<V> radiance{zero, zero, zero};
    if (weight < 1.0f) radiance = color(job_.hdr, x, y);
    if (weight > 0.0f) radiance = mix(radiance, color(job_.mean, x, y), set(weight));
    const V light = luminance(radiance);
    const V stops = hn::Log2(d_, hn::Max(light, set(1e-30f))) - set(shared::exposure_darkest);
    const V bin = hn::Min(stops * set(shared::exposure_bins_per_stop),
                          set(static_cast<float>(shared::exposure_bins) - 1.001f));
    HWY_ALIGN std::array<float, hn::MaxLanes(D())> at;
    hn::Store(
        hn::IfThenElse(hn::Gt(light, set(std::exp2(shared::exposure_darkest))), bin, set(-1.0f)),
        d_, at.data());
    for (int i = 0; i < static_cast<int>(hn::Lanes(d_)); ++i) {
      if ((x + i) % 2 == 0 && x + i >= start) add(at[static_cast<std::size_t>(i)]);
    }
  }

  HWY_INLINE void add(float bin) const {
    if (!(bin >= 0.0f)) return;
    const auto lower = static_cast<std::uint32_t>(bin);
    const float fraction = bin - static_cast<float>(lower);
    const auto upper =
        static_cast<std::uint32_t>(fraction * static_cast<float>(shared::exposure_pixel_weight));
    bins_[lower] += shared::exposure_pixel_weight - upper;
    bins_[lower + 1] += upper;
  }

  const D d_{};
  const ExposureMeterJob& job_;
  Bins& bins_;
};

void meter_rows(const ExposureMeterJob& job, int first, int last, Bins& bins) {
  using Wide = hn::ScalableTag<float>;
  if (static_cast<std::size_t>(job.width) >= hn::Lanes(Wide())) {
    Metering<Wide>(job, bins).rows(first, last);
  } else {
    Metering<hn::FixedTag<float, 1>>(job, bins).rows(first, last);
  }
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {
namespace {

/// Mean log2 luminance of the metered pixels without the darkest and the brightest twentieth;
/// nothing where there are none.
std::optional<float> metered_mean(std::span<const std::uint32_t> bins) {
  float total = 0.0f;
  for (const std::uint32_t count : bins) total += static_cast<float>(count);
  const float low = 0.05f * total, high = 0.95f * total;
  float below = 0.0f, sum = 0.0f, weight = 0.0f;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const auto count = static_cast<float>(bins[i]);
    const float inside = std::max(std::min(below + count, high) - std::max(below, low), 0.0f);
    below += count;
    sum += inside * static_cast<float>(i);
    weight += inside;
  }
  if (!(weight > 0.0f)) return std::nullopt;
  return shared::exposure_darkest + sum / std::max(weight, 1.0f) / shared::exposure_bins_per_stop;
}

}  // namespace

HWY_EXPORT(meter_rows);

void exposure_begin(const ExposureBeginJob& job) {
  std::fill_n(job.histogram.data, shared::exposure_bins, 0u);
}

void exposure_meter(const ExposureMeterJob& job) {
  static_assert(band_rows % 2 == 0);
  for_each_band(job.height, [&](int first, int last) {
    std::array<std::uint32_t, shared::exposure_bins> bins{};
    HWY_DYNAMIC_DISPATCH(meter_rows)(job, first, last, bins);
    for (std::size_t i = 0; i < bins.size(); ++i) {
      if (bins[i]) std::atomic_ref(job.histogram[i]).fetch_add(bins[i]);
    }
  });
}

void exposure_adapt(const ExposureAdaptJob& job) {
  const shared::FrameConstants& frame = job.frame;
  shared::ExposureState now{frame.exposure_factor, 0.0f, 0.0f, 0.0f};
  const float reach = job.constants.reach;
  if (reach > 0.0f) {
    const bool first = frame.history_invalid != 0;
    now.target = first ? 0.0f : job.state->target;
    if (const auto mean = metered_mean({job.histogram.data, shared::exposure_bins})) {
      now.target = std::log2(shared::exposure_middle_grey) - *mean;
    }
    now.target = std::clamp(now.target, shared::exposure_lowest, shared::exposure_highest);
    now.target = std::clamp(now.target, -reach, reach);
    now.stops = now.target;
    if (!first && job.constants.adaptation > 0.0f) {
      const float kept = std::exp(-job.constants.seconds / job.constants.adaptation);
      now.stops += (job.state->stops - now.target) * kept;
    }
    now.factor = frame.exposure_factor * std::exp2(now.stops);
  }
  *job.state.data = now;
  *job.report.data = now;
}

}  // namespace heliograph::render::kernels
#endif
