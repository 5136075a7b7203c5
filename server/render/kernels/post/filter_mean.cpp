#include "render/kernels/post/filter_mean.hpp"

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/post/filter_mean.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D>
class MeanFilter {
  using V = hn::Vec<D>;

  /// Of every pixel: the difference of mean and frame, its luminance and that of the frame, all of
  /// exposed radiance; the variance of the luminance.
  enum Channels { red, green, blue, difference, seen, variance, channel_count };
  /// Over the window: of the first three times their weights, of weights and of their squares.
  enum Sums { weights = 3, squares, sum_count };
  static constexpr int window = 3;  // pixels on either side that are averaged
  static constexpr int patch_reach = 1;
  static constexpr int reach = window + patch_reach;
  static constexpr int surroundings = 4;  // pixels on either side whose variance is averaged
  // Columns whose channels and sums fit into the first cache together.
  static constexpr int columns = 64;
  static constexpr float least_noise = 1e-9f;
  static constexpr float guide_weight = 75.0f;
  static constexpr float greatest = 65504.0f;  // of half floats

 public:
  HWY_INLINE explicit MeanFilter(const FilterMeanJob& job)
      : job_(job), width_(static_cast<int>(job.constants.shown.x)) {}

  HWY_INLINE void rows(int first, int last) const {
    if (job_.constants.noise_scale == 0.0f) return copy(first, last);
    const BandScratch pixels(channel_count, width_, first, last, reach);
    const BandScratch sums(sum_count, width_, first, last, 0);
    const BandScratch apart(1, width_, first, last, patch_reach);
    prepare(pixels, first, last);
    for (int y = first; y < last; ++y) {
      for (int sum = 0; sum < sum_count; ++sum) std::fill_n(sums.row(sum, y), width_, 0.0f);
    }
    for (int left = 0; left < width_; left += columns) {
      const int right = std::min(left + columns, width_);
      for (int i = 0; i < (2 * window + 1) * (2 * window + 1); ++i) {
        const int across = i % (2 * window + 1) - window, down = i / (2 * window + 1) - window;
        for (int y = first - patch_reach; y < last + patch_reach; ++y) {
          compare(pixels, apart.row(0, y), across, y, y + down, left, right);
        }
        for (int y = first; y < last; ++y) add(pixels, apart, sums, across, y, down, left, right);
      }
    }
    for (int y = first; y < last; ++y) finish(pixels, sums, y);
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  /// The last block reaches back over columns that are done.
  template <class Work>
  HWY_INLINE void each_block(int left, int right, const Work& work) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int x = left; x < right; x += lanes) work(std::min(x, right - lanes));
  }
  HWY_INLINE Quad<V> load(const gpu::HostView& image, int x, int y) const {
    return load4(d_, row_of<const float>(image, y) + 4 * x);
  }

  HWY_INLINE void copy(int first, int last) const {
    for (int y = first; y < last; ++y) {
      each_block(0, width_, [&](int x) HWY_ATTR {
        const Quad<V> frame = load(job_.radiance, x, y), mean = load(job_.mean, x, y);
        keep({frame.x, frame.y, frame.z}, {mean.x, mean.y, mean.z},
             mean.w * set(job_.constants.variance_scale), x, y);
      });
    }
  }

  /// Where there is a number that is none, the frame is kept.
  HWY_INLINE void keep(const Triple<V>& shown, const Triple<V>& color, V variance, int x,
                       int y) const {
    const auto bad = hn::Or(is_bad(color), is_bad(variance));
    const auto half = [&](V otherwise, V v) HWY_ATTR {
      return clamped(hn::IfThenElse(bad, otherwise, v), -greatest, greatest);
    };
    store_half4(d_,
                {half(shown.x, color.x), half(shown.y, color.y), half(shown.z, color.z),
                 half(hn::Zero(d_), hn::Sqrt(variance))},
                row_of<std::uint32_t>(job_.filtered, y) + 2 * x);
  }

  /// From radiance to the exposed image, in which bright pixels differ less.
  HWY_INLINE V unit_of(V frame, V mean) const {
    const float factor = job_.exposure->factor;
    return set(factor) / hn::MulAdd(frame + mean, set(0.5f * factor), set(1.0f));
  }

  HWY_INLINE int clamped_row(int y) const {
    return std::clamp(y, 0, static_cast<int>(job_.constants.shown.y) - 1);
  }

  HWY_INLINE void prepare(const BandScratch& pixels, int first, int last) const {
    const BandScratch variances(2, width_, first, last, reach + surroundings);
    for (int y = first - reach - surroundings; y < last + reach + surroundings; ++y) {
      const bool inside = y >= first - reach && y < last + reach;
      prepare_row(inside ? &pixels : nullptr, variances, y);
    }
    for (int y = first - reach; y < last + reach; ++y) {
      raise_variances(variances, pixels.row(variance, y), clamped_row(y));
      for (int channel = 0; channel < channel_count; ++channel) pixels.extend(channel, y);
    }
  }

  /// Of `variances`: the first channel, and in the second its sums over the columns of the
  /// surroundings.
  HWY_INLINE void prepare_row(const BandScratch* pixels, const BandScratch& variances,
                              int y) const {
    const int from = clamped_row(y);
    float* const noises = variances.row(0, y);
    each_block(0, width_, [&](int x) HWY_ATTR {
      const Quad<V> frame = load(job_.radiance, x, from), mean = load(job_.mean, x, from);
      const V shown = luminance(Triple<V>{frame.x, frame.y, frame.z});
      const V averaged = luminance(Triple<V>{mean.x, mean.y, mean.z});
      const V unit = unit_of(shown, averaged);
      const Triple<V> apart{(mean.x - frame.x) * unit, (mean.y - frame.y) * unit,
                            (mean.z - frame.z) * unit};
      const V noise = mean.w * set(job_.constants.variance_scale) * unit * unit;
      // A number that is none must not spread.
      const auto good = hn::Not(hn::Or(is_bad(apart), is_bad(noise)));
      hn::StoreU(hn::IfThenElseZero(good, noise), d_, noises + x);
      if (!pixels) return;
      const auto put = [&](int channel, V value) HWY_ATTR {
        hn::StoreU(hn::IfThenElseZero(good, value), d_, pixels->row(channel, y) + x);
      };
      put(red, apart.x);
      put(green, apart.y);
      put(blue, apart.z);
      put(difference, luminance(apart));
      put(seen, shown * unit_of(shown, shown));
      put(variance, noise);
    });
    variances.extend(0, y);
    each_block(0, width_, [&](int x) HWY_ATTR {
      V sum = hn::Zero(d_);
      for (int i = -surroundings; i <= surroundings; ++i) sum = sum + hn::LoadU(d_, noises + x + i);
      hn::StoreU(sum, d_, variances.row(1, y) + x);
    });
  }

  /// Variances of a row are no less than the share of its surroundings, those of row `y`.
  HWY_INLINE void raise_variances(const BandScratch& variances, float* own, int y) const {
    constexpr float count = (2 * surroundings + 1) * (2 * surroundings + 1);
    each_block(0, width_, [&](int x) HWY_ATTR {
      V sum = hn::Zero(d_);
      for (int i = -surroundings; i <= surroundings; ++i) {
        sum = sum + hn::LoadU(d_, variances.row(1, y + i) + x);
      }
      const V prior = sum * set(job_.constants.prior_share / count);
      hn::StoreU(hn::Max(hn::LoadU(d_, own + x), prior), d_, own + x);
    });
  }

  /// apart() of the shader, of row `y` and what lies `across` in row `other`.
  HWY_INLINE void compare(const BandScratch& pixels, float* to, int across, int y, int other,
                          int left, int right) const {
    const float* const own_difference = pixels.row(difference, y);
    const float* const own_seen = pixels.row(seen, y);
    const float* const own_variance = pixels.row(variance, y);
    const float* const their_difference = pixels.row(difference, other) + across;
    const float* const their_seen = pixels.row(seen, other) + across;
    const float* const their_variance = pixels.row(variance, other) + across;
    each_block(left - patch_reach, right + patch_reach, [&](int x) HWY_ATTR {
      const V apart = hn::LoadU(d_, own_difference + x) - hn::LoadU(d_, their_difference + x);
      const V guide = hn::LoadU(d_, own_seen + x) - hn::LoadU(d_, their_seen + x);
      const V noise = hn::LoadU(d_, own_variance + x) + hn::LoadU(d_, their_variance + x);
      const V ratio = apart * apart / (noise + set(least_noise));
      hn::StoreU(hn::MulAdd(guide * guide, set(guide_weight), ratio), d_, to + x);
    });
  }

  /// likeness() of the shader, and what it weighs.
  HWY_INLINE void add(const BandScratch& pixels, const BandScratch& apart, const BandScratch& sums,
                      int across, int y, int down, int left, int right) const {
    const float* const above = apart.row(0, y - 1);
    const float* const at = apart.row(0, y);
    const float* const below = apart.row(0, y + 1);
    each_block_once(left, right, [&](int x, auto start) HWY_ATTR {
      V sum = hn::Zero(d_);
      for (int i = -patch_reach; i <= patch_reach; ++i) {
        sum = sum + (hn::LoadU(d_, above + x + i) + hn::LoadU(d_, at + x + i) +
                     hn::LoadU(d_, below + x + i));
      }
      V like = clamped(hn::NegMulAdd(sum, set(1.0f / 9.0f), set(2.0f)), 0.0f, 1.0f);
      like = like * like;
      like = hn::IfThenElseZero(start, like * like);
      const auto gather = [&](int sum_of, V value) HWY_ATTR {
        float* const to = sums.row(sum_of, y) + x;
        hn::StoreU(hn::MulAdd(like, value, hn::LoadU(d_, to)), d_, to);
      };
      for (int channel = red; channel <= blue; ++channel) {
        gather(channel, hn::LoadU(d_, pixels.row(channel, y + down) + x + across));
      }
      gather(weights, set(1.0f));
      gather(squares, like);
    });
  }

  /// Calls `work(x, lanes)`: of the last block only the lanes that are not done yet.
  template <class Work>
  HWY_INLINE void each_block_once(int left, int right, const Work& work) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int x = left; x < right; x += lanes) {
      const int from = std::min(x, width_ - lanes);
      work(from, hn::And(from_column(d_, from, x), before_column(from, right)));
    }
  }
  HWY_INLINE hn::Mask<D> before_column(int x, int end) const {
    return hn::Lt(hn::Iota(d_, static_cast<float>(x)), set(static_cast<float>(end)));
  }

  HWY_INLINE void finish(const BandScratch& pixels, const BandScratch& sums, int y) const {
    each_block(0, width_, [&](int x) HWY_ATTR {
      const Quad<V> frame = load(job_.radiance, x, y), mean = load(job_.mean, x, y);
      const Triple<V> shown{frame.x, frame.y, frame.z};
      const V unit = unit_of(luminance(shown), luminance(Triple<V>{mean.x, mean.y, mean.z}));
      const auto sum = [&](int which) HWY_ATTR { return hn::LoadU(d_, sums.row(which, y) + x); };
      const V weight = sum(weights), scale = set(1.0f) / (weight * unit);
      const Triple<V> filtered{hn::MulAdd(sum(red), scale, shown.x),
                               hn::MulAdd(sum(green), scale, shown.y),
                               hn::MulAdd(sum(blue), scale, shown.z)};
      const V share = sum(squares) / (weight * weight);
      const V noise = hn::Max(hn::LoadU(d_, pixels.row(variance, y) + x) / (unit * unit),
                              mean.w * set(job_.constants.variance_scale));
      keep(shown, filtered, noise * set(job_.constants.noise_scale) * share, x, y);
    });
  }

  const D d_{};
  const FilterMeanJob& job_;
  int width_;
};

void filter_rows(const FilterMeanJob& job, int first, int last) {
  run_rows<MeanFilter>(job, static_cast<int>(job.constants.shown.x), first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(filter_rows);

void filter_mean(const FilterMeanJob& job) {
  for_each_band(static_cast<int>(job.constants.shown.y), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(filter_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
