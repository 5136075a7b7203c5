#include "render/kernels/post/mean_weight.hpp"

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/post/mean_weight.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D>
class MeanWeighing {
  using V = hn::Vec<D>;

  /// Of every pixel: the mean's variance and its squared distance from the denoised frame; sums of
  /// both over five pixels of a row.
  enum Channels { variance, distance, channel_count };
  static constexpr int window = 2;     // pixels on either side that are averaged
  static constexpr int smoothing = 1;  // the same of the weights
  static constexpr int reach = window + smoothing;

 public:
  HWY_INLINE explicit MeanWeighing(const MeanWeightJob& job)
      : job_(job),
        width_(static_cast<int>(job.constants.shown.x)),
        height_(static_cast<int>(job.constants.shown.y)) {}

  HWY_INLINE void rows(int first, int last) const {
    const BandScratch pixels(channel_count, width_, first, last, reach);
    const BandScratch sums(channel_count, width_, first, last, reach);
    const BandScratch weights(1, width_, first, last, smoothing);
    for (int y = first - reach; y < last + reach; ++y) {
      compare(pixels, y);
      add_across(pixels, sums, y);
    }
    for (int y = first - smoothing; y < last + smoothing; ++y) {
      each_block([&](int x) HWY_ATTR { weigh(sums, weights, x, y); });
      weights.extend(0, y);
    }
    for (int y = first; y < last; ++y) {
      each_block([&](int x) HWY_ATTR { smooth(weights, x, y); });
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  template <class Work>
  HWY_INLINE void each_block(const Work& work) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int x = 0; x < width_; x += lanes) work(std::min(x, width_ - lanes));
  }
  /// Both in units of the exposed image, in which bright pixels differ less.
  HWY_INLINE void compare(const BandScratch& pixels, int y) const {
    const int from = std::clamp(y, 0, height_ - 1);
    const V half_factor = set(0.5f * job_.exposure->factor), one = set(1.0f);
    each_block([&](int x) HWY_ATTR {
      const Quad<V> frame = load4(d_, row_of<const float>(job_.radiance, from) + 4 * x);
      const Quad<V> mean = load_half4(d_, row_of<const std::uint32_t>(job_.mean, from) + 2 * x);
      const V shown = luminance(Triple<V>{frame.x, frame.y, frame.z});
      const V averaged = luminance(Triple<V>{mean.x, mean.y, mean.z});
      const V compression = one / hn::MulAdd(shown + averaged, half_factor, one);
      const V unit = compression * compression;
      const V apart = averaged - shown;
      hn::StoreU(mean.w * mean.w * unit, d_, pixels.row(variance, y) + x);
      hn::StoreU(apart * apart * unit, d_, pixels.row(distance, y) + x);
    });
    pixels.extend(variance, y);
    pixels.extend(distance, y);
  }

  HWY_INLINE void add_across(const BandScratch& pixels, const BandScratch& sums, int y) const {
    for (int channel = 0; channel < channel_count; ++channel) {
      const float* const from = pixels.row(channel, y);
      float* const to = sums.row(channel, y);
      each_block([&](int x) HWY_ATTR {
        V sum = hn::LoadU(d_, from + x - window);
        for (int i = 1 - window; i <= window; ++i) sum = sum + hn::LoadU(d_, from + x + i);
        hn::StoreU(sum, d_, to + x);
      });
    }
  }

  HWY_INLINE V sum_down(const BandScratch& sums, int channel, int x, int y) const {
    V sum = hn::LoadU(d_, sums.row(channel, y - window) + x);
    for (int i = 1 - window; i <= window; ++i) {
      sum = sum + hn::LoadU(d_, sums.row(channel, y + i) + x);
    }
    return sum;
  }

  HWY_INLINE void weigh(const BandScratch& sums, const BandScratch& weights, int x, int y) const {
    const int at = std::clamp(y, 0, height_ - 1);
    const V noise = sum_down(sums, variance, x, at), apart = sum_down(sums, distance, x, at);
    // Where there is a number that is none, the frame is shown.
    const V weight = set(1.0f) - noise / apart;
    hn::StoreU(hn::IfThenElseZero(hn::Gt(apart, noise), weight), d_, weights.row(0, y) + x);
  }

  HWY_INLINE void smooth(const BandScratch& weights, int x, int y) const {
    V sum = hn::Zero(d_);
    for (int i = 0; i < 9; ++i) {
      sum = sum + hn::LoadU(d_, weights.row(0, y + i / 3 - 1) + x + i % 3 - 1);
    }
    hn::StoreU(sum * set(1.0f / 9.0f), d_, row_of<float>(job_.weight, y) + x);
  }

  const D d_{};
  const MeanWeightJob& job_;
  int width_, height_;
};

void weigh_rows(const MeanWeightJob& job, int first, int last) {
  run_rows<MeanWeighing>(job, static_cast<int>(job.constants.shown.x), first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(weigh_rows);

void mean_weight(const MeanWeightJob& job) {
  for_each_band(static_cast<int>(job.constants.shown.y), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(weigh_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
