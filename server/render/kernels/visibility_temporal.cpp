#include "render/kernels/simd/rows.hpp"
#include "render/kernels/temporal.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/visibility_temporal.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/history_reader.hpp"
#include "render/kernels/simd/guide.hpp"
#include "render/kernels/simd/moments.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D>
class VisibilityAccumulation {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  struct HistorySample {
    Pair<V> signal;
    Quad<V> moments;
    Pair<V> frames;  // 0: nothing
    Pair<V> fast;
  };
  struct Channel {
    V value, variance, first, second, frames, fast;
  };

 public:
  HWY_INLINE explicit VisibilityAccumulation(const TemporalVisibilityJob& job)
      : job_(job), c_(job.constants), bounds_(job.width, job.height) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < job_.width; x += lanes) block(std::min(x, job_.width - lanes), y);
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  HWY_INLINE Quad<V> load(const gpu::HostView& image, int x, int y) const {
    return load4(d_, row_of<const float>(image, y) + 4 * x);
  }
  HWY_INLINE Quad<V> where(M seen, const Quad<V>& t) const {
    return {hn::IfThenElseZero(seen, t.x), hn::IfThenElseZero(seen, t.y),
            hn::IfThenElseZero(seen, t.z), hn::IfThenElseZero(seen, t.w)};
  }

  HWY_INLINE HistorySample fetch_history(int x, int y) const {
    const V zero = hn::Zero(d_);
    HistorySample r{{zero, zero}, {zero, zero, zero, zero}, {zero, zero}, {zero, zero}};
    if ((c_.flags & shared::temporal_history_valid) == 0) return r;
    const HistoryTaps<D> taps = history_taps<D>(load(job_.reprojection, x, y));
    const HistoryReader<D> reader(taps, job_.width, job_.height);
    const bool bicubic = (c_.flags & shared::temporal_bicubic) != 0;
    const Quad<V> signal = bicubic ? reader.template bicubic<Fractions>(job_.previous_history)
                                   : reader.template bilinear<Fractions>(job_.previous_history);
    const Quad<V> frames = reader.template bilinear<Halves>(job_.previous_history_length);
    r.signal = {signal.x, signal.y};
    r.moments = reader.template bilinear<Fractions>(job_.previous_moments);
    r.frames = {frames.x, frames.y};
    // The gradient compares with the long history alone.
    if (c_.rectification != shared::rectification_gradient) r.fast = fetch_fast_history(taps);
    return r;
  }

  HWY_INLINE Pair<V> fetch_fast_history(const HistoryTaps<D>& taps) const {
    Pair<V> sum{hn::Zero(d_), hn::Zero(d_)};
    for (int i = 0; i < 4; ++i) {
      const M valid = hn::Gt(taps.weights[i], hn::Zero(d_));
      if (hn::AllFalse(d_, valid)) continue;
      const Pair<V> fast =
          bounds_.gather(taps.tap_x(i), taps.tap_y(i)).two_halves(job_.previous_fast_history);
      add_weighted<D>(valid, taps.weights[i], fast.x, sum.x);
      add_weighted<D>(valid, taps.weights[i], fast.y, sum.y);
    }
    return sum;
  }

  HWY_INLINE Channel accumulate(V now, V old, V first, V second, V reprojected_history, V fast,
                                float longest) const {
    // The history counts what was sampled: without a sample it stays as it is.
    const M sampled = hn::Ge(now, hn::Zero(d_));
    const V one = set(1.0f);
    Channel c;
    c.frames = hn::Min(reprojected_history + hn::IfThenElseZero(sampled, one), set(longest));
    const auto weight_in = [&](float most) HWY_ATTR {
      return hn::IfThenElseZero(sampled, sample_weight(c.frames, most));
    };
    c.value = mix(old, now, weight_in(longest));
    const V weight = weight_in(c_.moments_frames);
    c.first = mix(first, now, weight);
    c.second = mix(second, now * now, weight);
    c.variance = sample_variance(c.first, c.second, hn::Min(c.frames, set(c_.moments_frames)));
    if (c_.flags & shared::temporal_mean_variance) c.variance = c.variance / hn::Max(c.frames, one);
    if (c_.rectification == shared::rectification_gradient) {
      const V change = hn::IfThenElseZero(hn::Gt(reprojected_history, hn::Zero(d_)), now - old);
      c.fast = hn::IfThenElse(sampled, change, set(shared::change_unknown));
    } else {
      c.fast = mix(fast, now, weight_in(fast_frames));
    }
    return c;
  }

  HWY_INLINE void block(int x, int y) const {
    const V zero = hn::Zero(d_);
    const Quad<V> now = load(job_.noisy, x, y);
    const M seen = guide_is_surface(load(job_.guide, x, y));
    const HistorySample old = fetch_history(x, y);
    const Channel shadow =
        accumulate(now.x, old.signal.x, old.moments.x, old.moments.z, old.frames.x, old.fast.x,
                   std::min(c_.frames, c_.light_frames));
    const Channel ambient = accumulate(now.y, old.signal.y, old.moments.y, old.moments.w,
                                       old.frames.y, old.fast.y, c_.frames);
    const Quad<V> signal{
        hn::IfThenElse(seen, shadow.value, now.x), hn::IfThenElse(seen, ambient.value, now.y),
        hn::IfThenElseZero(seen, shadow.variance), hn::IfThenElseZero(seen, ambient.variance)};
    store4(d_, signal, row_of<float>(job_.signal, y) + 4 * x);
    const Rounding<D> rounding(x, y, job_.frame.sample_index);
    store_history4<Fractions>(d_, signal, rounding, job_.history, x, y);
    const Quad<V> moments{shadow.first, ambient.first, shadow.second, ambient.second};
    store_history4<Fractions>(d_, where(seen, moments), rounding, job_.moments, x, y);
    const Quad<V> frames{shadow.frames, ambient.frames, zero, zero};
    store_history4<Halves>(d_, where(seen, frames), rounding, job_.history_length, x, y);
    const Pair<V> fast{hn::IfThenElseZero(seen, shadow.fast),
                       hn::IfThenElseZero(seen, ambient.fast)};
    store_halves2(d_, fast, rounding, job_.fast_history, x, y);
  }

  const D d_{};
  const TemporalVisibilityJob& job_;
  const shared::TemporalConstants& c_;
  Bounds<D> bounds_;
};

void accumulate_visibility_rows(const TemporalVisibilityJob& job, int first, int last) {
  run_rows<VisibilityAccumulation>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(accumulate_visibility_rows);

bool can_accumulate(std::uint32_t rectification) {
  return rectification == shared::rectification_off ||
         rectification == shared::rectification_fast_history ||
         rectification == shared::rectification_gradient;
}

void visibility_temporal(const TemporalVisibilityJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(accumulate_visibility_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
