#include "render/kernels/simd/rows.hpp"
#include "render/kernels/temporal.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/rectify.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/denoise/history_texels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Mean and deviation of the neighbours' short histories, with which both signals are held: sums
/// over columns first, then over rows of those sums.
template <class D, int channels>
class WindowBoxes {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  static constexpr int count_row = 2 * channels;  // after values and their squares
  static constexpr int surfaces_row = count_row + 1;
  static constexpr float least_sampled =
      channels == 2 ? shared::min_sampled_fraction : shared::min_sampled_fraction_specular;

 public:
  struct Box {
    V low[channels];
    V high[channels];
  };

  HWY_INLINE WindowBoxes(const RectifyJob& job, int first, int last)
      : job_(job),
        radius_(job.constants.radius),
        values_(channels + 2, job.width, first, last, radius_),
        sums_(2 * channels + 2, job.width, 0, 1, radius_) {}

  /// Takes one row of values and counts those of surfaces that were sampled: `load(x, y, values)`
  /// gives the values and in which pixels they are known.
  template <class Load>
  HWY_INLINE void fill(int y, const Load& load) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    if (y < 0 || y >= job_.height) {
      for (int c = 0; c < channels + 2; ++c) std::fill_n(values_.row(c, y), job_.width, 0.0f);
      return;
    }
    for (int i = 0; i < job_.width; i += lanes) {
      const int x = std::min(i, job_.width - lanes);
      const V view_z = load4(d_, row_of<const float>(job_.guide, y) + 4 * x).w;
      V values[channels];
      const M surface = hn::Gt(view_z, hn::Zero(d_));
      const M seen = hn::And(surface, load(x, y, values));
      for (int c = 0; c < channels; ++c) {
        hn::StoreU(hn::IfThenElseZero(seen, values[c]), d_, values_.row(c, y) + x);
      }
      const V one = hn::Set(d_, 1.0f);
      hn::StoreU(hn::IfThenElseZero(seen, one), d_, values_.row(channels, y) + x);
      hn::StoreU(hn::IfThenElseZero(surface, one), d_, values_.row(channels + 1, y) + x);
    }
  }

  /// Lanes with a surface, of a row that was filled.
  HWY_INLINE M surfaces(int x, int y) const {
    return hn::Gt(hn::LoadU(d_, values_.row(channels + 1, y) + x), hn::Zero(d_));
  }

  /// Prepares the boxes of row `y`.
  HWY_INLINE void sum_columns(int y) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int i = 0; i < job_.width; i += lanes) {
      const int x = std::min(i, job_.width - lanes);
      for (int c = 0; c < channels + 2; ++c) {
        V sum = hn::Zero(d_), squares = sum;
        for (int row = y - radius_; row <= y + radius_; ++row) {
          const V value = hn::LoadU(d_, values_.row(c, row) + x);
          sum = sum + value;
          if (c < channels) squares = hn::MulAdd(value, value, squares);
        }
        hn::StoreU(sum, d_, sums_.row(c < channels ? c : channels + c, 0) + x);
        if (c < channels) hn::StoreU(squares, d_, sums_.row(channels + c, 0) + x);
      }
    }
    for (int c = 0; c <= surfaces_row; ++c) sums_.fill_beyond(c, 0, 0.0f);
  }

  HWY_INLINE Box box(int x) const {
    const V one = hn::Set(d_, 1.0f), zero = hn::Zero(d_);
    const V count = across(count_row, x);
    const V inv_count = one / hn::Max(count, one);
    V scale = hn::Set(d_, job_.constants.scale);
    V least = hn::Set(d_, shared::visibility_rounding);
    if (channels == 3) least = across(0, x) * inv_count * hn::Set(d_, shared::specular_rounding);
    if (job_.constants.rectification == shared::rectification_gradient) {
      // mean_box() of shaders/lib/denoise/rectification.glsl
      const V surfaces = across(surfaces_row, x);
      scale = scale * hn::Sqrt(surfaces * inv_count);
      const V enough = hn::MulSub(hn::Set(d_, least_sampled), surfaces, hn::Set(d_, 0.5f));
      least = hn::IfThenElseZero(hn::Lt(count, enough), hn::Set(d_, 1e30f));
    }
    Box made;
    for (int c = 0; c < channels; ++c) {
      const V mean = across(c, x) * inv_count;
      const V spread = hn::NegMulAdd(mean, mean, across(channels + c, x) * inv_count);
      const V half_extent = hn::MulAdd(scale, hn::Sqrt(hn::Max(spread, zero)), least);
      made.low[c] = mean - half_extent;
      made.high[c] = mean + half_extent;
    }
    return made;
  }

 private:
  HWY_INLINE V across(int row, int x) const {
    const float* const from = sums_.row(row, 0) + x;
    V sum = hn::Zero(d_);
    for (int i = -radius_; i <= radius_; ++i) sum = sum + hn::LoadU(d_, from + i);
    return sum;
  }

  const D d_{};
  const RectifyJob& job_;
  int radius_;
  BandScratch values_;
  BandScratch sums_;
};

template <class V>
HWY_INLINE V held_between(V value, V low, V high) {
  return hn::Min(hn::Max(value, low), high);
}

/// shortened_history() of shaders/lib/denoise/rectification.glsl
template <class V>
HWY_INLINE V shortened_history(V frames, V moved, V half_extent) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  const V moved_fraction = moved / hn::Max(moved + half_extent, hn::Set(d, 1e-6f));
  return hn::Max(frames * (one - moved_fraction), hn::Min(frames, one));
}

/// Of a neighbourhood whose mean change lies between `low` and `high`, what is beyond doubt
/// (shaders/lib/denoise/rectification.glsl), and how long a history may last under it
/// (moments.glsl).
template <class V>
HWY_INLINE V certain_change(V low, V high) {
  return hn::Max(hn::Max(low, hn::Neg(high)), hn::Zero(hn::DFromV<V>()));
}
template <class V>
HWY_INLINE V frames_under_motion(V motion) {
  const hn::DFromV<V> d;
  const V logarithm = hn::Log(d, clamped(motion, 1e-6f, 1.0f));
  const V power = hn::Exp(d, hn::Set(d, shared::motion_history_exponent) * logarithm);
  return hn::MulAdd(hn::Set(d, shared::motion_history_factor), power - hn::Set(d, 1.0f),
                    hn::Set(d, 1.0f));
}

/// What both signals have in common: Kernel::load() gives what the boxes are made of, and
/// Kernel::hold() holds a block of pixels in them, or Kernel::shorten() their histories.
template <class D, class Kernel, int channels>
class Rectification {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

 public:
  HWY_INLINE explicit Rectification(const RectifyJob& job) : job_(job) {}

  HWY_INLINE void rows(int first, int last) const {
    const auto& kernel = static_cast<const Kernel&>(*this);
    const WindowBoxes<D, channels> boxes(job_, first, last);
    const int radius = job_.constants.radius;
    const auto load = [&kernel](int x, int y, V* values)
                          HWY_ATTR { return kernel.load(x, y, values); };
    for (int y = first - radius; y < last + radius; ++y) boxes.fill(y, load);
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      boxes.sum_columns(y);
      for (int start = 0; start < job_.width; start += lanes) {
        const int x = std::min(start, job_.width - lanes);
        const M requested = hn::And(boxes.surfaces(x, y), from_column(d_, x, start));
        if (!hn::AllFalse(d_, requested)) hold(kernel, boxes, x, y, requested);
      }
    }
  }

 protected:
  /// The variance of the mean grows as the history shrinks.
  HWY_INLINE V growth(V before, V shortened) const {
    const V one = hn::Set(d_, 1.0f);
    if ((job_.constants.flags & shared::temporal_mean_variance) == 0) return one;
    return before / hn::Max(shortened, one);
  }

  const D d_{};
  const RectifyJob& job_;

 private:
  HWY_INLINE void hold(const Kernel& kernel, const WindowBoxes<D, channels>& boxes, int x, int y,
                       M requested) const {
    float* const signal = row_of<float>(job_.signal, y) + 4 * x;
    const Quad<V> value = load4(d_, signal);
    const Quad<V> state = load_history4<Halves>(d_, job_.history_length, x, y);
    Quad<V> new_value, new_state;
    if (job_.constants.rectification == shared::rectification_gradient) {
      kernel.shorten(boxes.box(x), x, y, value, state, new_value, new_state);
    } else {
      kernel.hold(boxes.box(x), value, state, new_value, new_state);
    }
    // Where nothing is requested the histories get what they hold.
    const Rounding<D> rounding(x, y, job_.frame.sample_index);
    const Quad<V> held = select(requested, new_value, value);
    store4(d_, held, signal);
    kernel.keep(held, rounding, x, y);
    store_history4<Halves>(d_, select(requested, new_state, state), rounding, job_.history_length,
                           x, y);
  }
};

template <class D>
class VisibilityRectification : public Rectification<D, VisibilityRectification<D>, 2> {
  using Base = Rectification<D, VisibilityRectification<D>, 2>;
  using Base::d_;
  using Base::job_;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Box = typename WindowBoxes<D, 2>::Box;

 public:
  HWY_INLINE explicit VisibilityRectification(const RectifyJob& job) : Base(job) {}

  HWY_INLINE M load(int x, int y, V* values) const {
    const Pair<V> fast = load_halves2(d_, job_.fast_history, x, y);
    const V unknown = hn::Set(d_, shared::change_unknown);
    const M no_shadow = hn::Eq(fast.x, unknown), no_ambient = hn::Eq(fast.y, unknown);
    values[0] = hn::IfThenZeroElse(no_shadow, fast.x);
    values[1] = hn::IfThenZeroElse(no_ambient, fast.y);
    return hn::Not(hn::And(no_shadow, no_ambient));
  }

  HWY_INLINE void keep(const Quad<V>& value, const Rounding<D>& rounding, int x, int y) const {
    store_history4<Fractions>(d_, value, rounding, job_.history, x, y);
  }

  HWY_INLINE void hold(const Box& box, const Quad<V>& value, const Quad<V>& state,
                       Quad<V>& new_value, Quad<V>& new_state) const {
    const V half = hn::Set(d_, 0.5f);
    const V x = held_between(value.x, box.low[0], box.high[0]);
    const V y = held_between(value.y, box.low[1], box.high[1]);
    const V moved_x = hn::Abs(x - value.x), moved_y = hn::Abs(y - value.y);
    const V frames_x = shortened_history(state.x, moved_x, half * (box.high[0] - box.low[0]));
    const V frames_y = shortened_history(state.y, moved_y, half * (box.high[1] - box.low[1]));
    new_value = {x, y, value.z * this->growth(state.x, frames_x),
                 value.w * this->growth(state.y, frames_y)};
    new_state = {frames_x, frames_y, moved_x, moved_y};
  }

  HWY_INLINE void shorten(const Box& box, int x, int y, const Quad<V>& value, const Quad<V>& state,
                          Quad<V>& new_value, Quad<V>& new_state) const {
    V changes[2];
    load(x, y, changes);
    const V one = hn::Set(d_, 1.0f);
    const V frames_x =
        hn::Min(state.x, frames_under_motion(certain_change(box.low[0], box.high[0])));
    const V frames_y =
        hn::Min(state.y, frames_under_motion(certain_change(box.low[1], box.high[1])));
    const V moved_x = changes[0] * (one / hn::Max(frames_x, one) - one / hn::Max(state.x, one));
    const V moved_y = changes[1] * (one / hn::Max(frames_y, one) - one / hn::Max(state.y, one));
    new_value = {value.x + moved_x, value.y + moved_y, value.z * this->growth(state.x, frames_x),
                 value.w * this->growth(state.y, frames_y)};
    new_state = {frames_x, frames_y, hn::Abs(moved_x), hn::Abs(moved_y)};
  }
};

template <class D>
class SpecularRectification : public Rectification<D, SpecularRectification<D>, 3> {
  using Base = Rectification<D, SpecularRectification<D>, 3>;
  using Base::d_;
  using Base::job_;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Box = typename WindowBoxes<D, 3>::Box;

 public:
  HWY_INLINE explicit SpecularRectification(const RectifyJob& job) : Base(job) {}

  HWY_INLINE M load(int x, int y, V* values) const {
    const Quad<V> fast = load_history4<Halves>(d_, job_.fast_history, x, y);
    const Triple<V> color = to_ycocg({fast.x, fast.y, fast.z});
    values[0] = color.x;
    values[1] = color.y;
    values[2] = color.z;
    // Of changes those with a distance below 0 are of no sample.
    const bool changes = job_.constants.rectification == shared::rectification_gradient;
    const V zero = hn::Zero(d_);
    return hn::Ge(changes ? fast.w : zero, zero);
  }

  HWY_INLINE void keep(const Quad<V>& value, const Rounding<D>& rounding, int x, int y) const {
    const V distance = load_history4<Halves>(d_, job_.fast_history, x, y).w;
    store_history4<Halves>(d_, Quad<V>{value.x, value.y, value.z, distance}, rounding, job_.history,
                           x, y);
  }

  HWY_INLINE void hold(const Box& box, const Quad<V>& value, const Quad<V>& state,
                       Quad<V>& new_value, Quad<V>& new_state) const {
    const Triple<V> color = to_ycocg({value.x, value.y, value.z});
    const Triple<V> held{held_between(color.x, box.low[0], box.high[0]),
                         held_between(color.y, box.low[1], box.high[1]),
                         held_between(color.z, box.low[2], box.high[2])};
    const V moved = hn::Abs(held.x - color.x);
    const V half_extent = hn::Set(d_, 0.5f) * (box.high[0] - box.low[0]);
    const V frames = shortened_history(state.x, moved, half_extent);
    const V rest = held.x - held.z;
    new_value = {rest + held.y, held.x + held.z, rest - held.y,
                 value.w * this->growth(state.x, frames)};
    new_state = {frames, moved, state.z, state.w};
  }

  HWY_INLINE void shorten(const Box& box, int x, int y, const Quad<V>& value, const Quad<V>& state,
                          Quad<V>& new_value, Quad<V>& new_state) const {
    const V one = hn::Set(d_, 1.0f), smallest = hn::Set(d_, 1e-4f);
    const V change = certain_change(box.low[0], box.high[0]);
    const V bright = hn::Abs(to_ycocg({value.x, value.y, value.z}).x);
    const V frames = hn::Min(state.x, frames_under_motion(change / (bright + change + smallest)));
    const V weight_change = one / hn::Max(frames, one) - one / hn::Max(state.x, one);
    const Quad<V> sampled = load_history4<Halves>(d_, job_.fast_history, x, y);
    const V moved = to_ycocg({sampled.x, sampled.y, sampled.z}).x * weight_change;
    new_value = {hn::MulAdd(sampled.x, weight_change, value.x),
                 hn::MulAdd(sampled.y, weight_change, value.y),
                 hn::MulAdd(sampled.z, weight_change, value.z),
                 value.w * this->growth(state.x, frames)};
    new_state = {frames, hn::Abs(moved), state.z, state.w};
  }

 private:
  HWY_INLINE Triple<V> to_ycocg(const Triple<V>& c) const {
    const V quarter = hn::Set(d_, 0.25f), half = hn::Set(d_, 0.5f);
    const V ends = (c.x + c.z) * quarter;
    return {hn::MulAdd(half, c.y, ends), half * (c.x - c.z), hn::MulSub(half, c.y, ends)};
  }
};

void rectify_visibility_rows(const RectifyJob& job, int first, int last) {
  run_rows<VisibilityRectification>(job, job.width, first, last);
}

void rectify_specular_rows(const RectifyJob& job, int first, int last) {
  run_rows<SpecularRectification>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(rectify_visibility_rows);
HWY_EXPORT(rectify_specular_rows);

void visibility_rectify(const RectifyJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(rectify_visibility_rows)(job, first, last);
  });
}

void specular_rectify(const RectifyJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(rectify_specular_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
