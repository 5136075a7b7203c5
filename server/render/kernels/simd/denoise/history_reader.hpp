// Texels of the frame before at the taps of pixels. Included once per instruction set; the guard is
// Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_HISTORY_READER_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_HISTORY_READER_HPP
#undef HELIOGRAPH_KERNELS_HISTORY_READER_HPP
#else
#define HELIOGRAPH_KERNELS_HISTORY_READER_HPP
#endif

#include "render/kernels/simd/denoise/history_texels.hpp"
#include "render/kernels/simd/history.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Catmull-Rom weights of four pixels in a row for a point at fraction `f` between the second and
/// the third.
template <class V>
HWY_INLINE void cubic_weights(V f, V (&weights)[4]) {
  const hn::DFromV<V> d;
  const V half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
  const V steep = hn::Set(d, 1.5f);
  weights[0] = f * (f * (one - half * f) - half);
  weights[1] = one + f * f * (steep * f - hn::Set(d, 2.5f));
  weights[2] = f * (half + f * (two - steep * f));
  weights[3] = f * f * (half * f - half);
}

/// Four channels of one pixel.
template <class Format>
class Texel {
  using Tag = hn::CappedTag<float, 4>;
  using V = hn::Vec<Tag>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int parts = 4 / lanes;

 public:
  static HWY_INLINE Texel load(const std::uint16_t* from) {
    const hn::Rebind<std::uint16_t, Tag> narrow;
    Texel t;
    for (int i = 0; i < parts; ++i) {
      t.part_[i] = Format::widened(Tag(), hn::LoadU(narrow, from + i * lanes));
    }
    if constexpr (parts == 1) {
      t.part_[0] = Format::linear(Tag(), t.part_[0]);
    } else {
      const auto of = Format::linear(Quad<V>{t.part_[0], t.part_[1], t.part_[2], t.part_[3]});
      t.part_[3] = of.w;
    }
    return t;
  }
  HWY_INLINE void store(float* to) const {
    for (int i = 0; i < parts; ++i) hn::StoreU(part_[i], Tag(), to + i * lanes);
  }
  HWY_INLINE Texel times(float weight) const {
    return each(*this, [weight](V a, V) HWY_ATTR { return hn::Mul(a, hn::Set(Tag(), weight)); });
  }
  /// this + t * weight
  HWY_INLINE Texel plus(const Texel& t, float weight) const {
    return each(t,
                [weight](V a, V b) HWY_ATTR { return hn::MulAdd(b, hn::Set(Tag(), weight), a); });
  }
  HWY_INLINE Texel lesser(const Texel& t) const {
    return each(t, [](V a, V b) HWY_ATTR { return hn::Min(a, b); });
  }
  HWY_INLINE Texel greater(const Texel& t) const {
    return each(t, [](V a, V b) HWY_ATTR { return hn::Max(a, b); });
  }

 private:
  template <class Operation>
  HWY_INLINE Texel each(const Texel& t, const Operation& operation) const {
    Texel result;
    for (int i = 0; i < parts; ++i) result.part_[i] = operation(part_[i], t.part_[i]);
    return result;
  }

  V part_[parts];
};

/// A vector of channels as they lie in memory, of several pixels.
template <class Format, class D>
class Channels {
  using V = hn::Vec<D>;

 public:
  static HWY_INLINE Channels load(const std::uint16_t* from) {
    const V widened = Format::widened(D(), hn::LoadU(hn::Rebind<std::uint16_t, D>(), from));
    return {Format::linear(D(), widened)};
  }
  HWY_INLINE void store(float* to) const { hn::StoreU(values_, D(), to); }
  HWY_INLINE Channels times(V weight) const { return {hn::Mul(values_, weight)}; }
  /// this + c * weight
  HWY_INLINE Channels plus(const Channels& c, V weight) const {
    return {hn::MulAdd(c.values_, weight, values_)};
  }
  HWY_INLINE Channels lesser(const Channels& c) const { return {hn::Min(values_, c.values_)}; }
  HWY_INLINE Channels greater(const Channels& c) const { return {hn::Max(values_, c.values_)}; }

 private:
  HWY_INLINE Channels(V values) : values_(values) {}

  V values_;
};

/// Reads rgba16f images (as Halves or MeanAndDeviation) and rgba16 images (as Fractions) of the
/// frame before. Pixels that moved together lie side by side there and are read in vectors of their
/// channels. Where they moved by different amounts, vectors of pixels would have to gather each
/// channel of each tap: there a vector holds the channels of one, and pixels take turns. Images
/// must be finite, for taps without a weight are read, too.
template <class D>
class HistoryReader {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;
  static constexpr int most_lanes = static_cast<int>(hn::MaxLanes(D()));

 public:
  HWY_INLINE HistoryReader(const HistoryTaps<D>& taps, int width, int height)
      : lanes_(static_cast<int>(hn::Lanes(d_))), taps_(taps) {
    const V zero = hn::Zero(d_), one = hn::Set(d_, 1.0f);
    // A position on a pixel's centre concerns no other column or row.
    place(taps.x, hn::Gt(taps.fraction_x, zero), width, columns_);
    place(taps.y, hn::Gt(taps.fraction_y, zero), height, rows_);
    cubic_weights(taps.fraction_x, across_);
    cubic_weights(taps.fraction_y, down_);
    // Without the corners, whose weights are next to nothing.
    const V scale = one / hn::NegMulAdd(across_[0] + across_[3], down_[0] + down_[3], one);
    for (V& weight : down_) weight = weight * scale;
    const int x = hn::GetLane(taps.x);
    const bool same_row = hn::AllTrue(di_, hn::Eq(taps.y, hn::Set(di_, hn::GetLane(taps.y))));
    const bool in_order = hn::AllTrue(di_, hn::Eq(taps.x, hn::Iota(di_, x)));
    const bool side_by_side = same_row && in_order;
    static_ = side_by_side && hn::AllTrue(d_, hn::Eq(taps.weights[0], one));
    together_ = !static_ && side_by_side && most_lanes >= 4 && x >= 1 && x + lanes_ + 2 <= width &&
                is_uniform(hn::Gt(taps.fraction_x, zero)) &&
                is_uniform(hn::Gt(taps.fraction_y, zero));
    if (static_ || together_) return;
    for (int i = 0; i < 4; ++i) {
      hn::StoreU(taps.weights[i], d_, bilinear_of_[i]);
      hn::StoreU(across_[i], d_, across_of_[i]);
      hn::StoreU(down_[i], d_, down_of_[i]);
    }
    hn::StoreU(hn::IfThenElseZero(taps.whole, one), d_, whole_);
  }

  /// The mean of the taps.
  template <class Format>
  HWY_INLINE Quad<V> bilinear(const gpu::HostView& image) const {
    if (static_) return here<Format>(image);
    if (together_) return in_units<Format>(mean_together<Format>(image));
    return in_units<Format>(read([&](int lane) HWY_ATTR { return mean<Format>(image, lane); }));
  }
  /// fetch_history_bicubic() of the shaders where all taps are valid, the mean elsewhere.
  template <class Format>
  HWY_INLINE Quad<V> bicubic(const gpu::HostView& image) const {
    if (static_) return here<Format>(image);
    if (together_) {
      const Quad<V> cubic = cubic_together<Format>(image);
      const bool whole = hn::AllTrue(d_, taps_.whole);
      return in_units<Format>(whole ? cubic
                                    : select(taps_.whole, cubic, mean_together<Format>(image)));
    }
    return in_units<Format>(read([&](int lane) HWY_ATTR {
      return whole_[lane] != 0.0f ? cubic<Format>(image, lane) : mean<Format>(image, lane);
    }));
  }

 private:
  HWY_INLINE bool is_uniform(hn::Mask<D> mask) const {
    return hn::AllTrue(d_, mask) || hn::AllFalse(d_, mask);
  }
  HWY_INLINE void place(VI first, hn::Mask<D> between, int size, int (&to)[4][most_lanes]) const {
    const VI next = hn::IfThenElse(hn::RebindMask(di_, between), hn::Set(di_, 1), hn::Zero(di_));
    const VI steps[] = {hn::Set(di_, -1), hn::Zero(di_), next, hn::Set(di_, 2)};
    for (int i = 0; i < 4; ++i) {
      const VI at = hn::Min(hn::Max(first + steps[i], hn::Zero(di_)), hn::Set(di_, size - 1));
      hn::StoreU(at, di_, to[i]);
    }
  }
  HWY_INLINE const std::uint16_t* texel(const gpu::HostView& image, int lane, int i, int j) const {
    return row_of<const std::uint16_t>(image, rows_[j][lane]) + 4 * columns_[i][lane];
  }
  template <class Format>
  HWY_INLINE Quad<V> here(const gpu::HostView& image) const {
    return load_history4<Format>(d_, image, columns_[1][0], rows_[1][0]);
  }
  template <class Format>
  HWY_INLINE Quad<V> in_units(const Quad<V>& t) const {
    if constexpr (Format::unit == 1.0f) return t;
    const V unit = hn::Set(d_, Format::unit);
    return {t.x * unit, t.y * unit, t.z * unit, t.w * unit};
  }

  /// What `value` makes of each part of the texels, of pixels that moved together: it gets where
  /// the part begins, in words from the first tap of the first pixel, and a function that gives the
  /// weights of the part's channels.
  template <class Value>
  HWY_INLINE Quad<V> read_together(const Value& value) const {
    HWY_ALIGN float texels[4 * most_lanes];
    for (int part = 0; part < 4 * lanes_; part += lanes_) {
      const auto pixel = hn::IndicesFromVec(d_, hn::ShiftRight<2>(hn::Iota(di_, part)));
      const auto spread = [&](V weights) HWY_ATTR { return hn::TableLookupLanes(weights, pixel); };
      value(part, spread).store(texels + part);
    }
    return load4(d_, texels);
  }

  template <class Format>
  HWY_INLINE Quad<V> mean_together(const gpu::HostView& image) const {
    return read_together([&](int part, const auto& spread) HWY_ATTR {
      const auto at = [&](int i, int j) HWY_ATTR {
        return Channels<Format, D>::load(texel(image, 0, i, j) + part);
      };
      return at(1, 1)
          .times(spread(taps_.weights[0]))
          .plus(at(2, 1), spread(taps_.weights[1]))
          .plus(at(1, 2), spread(taps_.weights[2]))
          .plus(at(2, 2), spread(taps_.weights[3]));
    });
  }

  template <class Format>
  HWY_INLINE Quad<V> cubic_together(const gpu::HostView& image) const {
    return read_together([&](int part, const auto& spread) HWY_ATTR {
      const auto at = [&](int i, int j) HWY_ATTR {
        return Channels<Format, D>::load(texel(image, 0, i, j) + part);
      };
      return sum_of_cubic<Channels<Format, D>>(at, across_, down_, spread);
    });
  }

  template <class Value>
  HWY_INLINE Quad<V> read(const Value& value) const {
    HWY_ALIGN float texels[4 * most_lanes];
    for (int lane = 0; lane < lanes_; ++lane) value(lane).store(texels + 4 * lane);
    return load4(d_, texels);
  }

  template <class Format>
  HWY_INLINE Texel<Format> mean(const gpu::HostView& image, int lane) const {
    using T = Texel<Format>;
    T sum = T::load(texel(image, lane, 1, 1)).times(bilinear_of_[0][lane]);
    sum = sum.plus(T::load(texel(image, lane, 2, 1)), bilinear_of_[1][lane]);
    sum = sum.plus(T::load(texel(image, lane, 1, 2)), bilinear_of_[2][lane]);
    return sum.plus(T::load(texel(image, lane, 2, 2)), bilinear_of_[3][lane]);
  }

  template <class Format>
  HWY_INLINE Texel<Format> cubic(const gpu::HostView& image, int lane) const {
    const auto at = [&](int i, int j)
                        HWY_ATTR { return Texel<Format>::load(texel(image, lane, i, j)); };
    const auto weight = [lane](const float(&of)[most_lanes]) HWY_ATTR { return of[lane]; };
    return sum_of_cubic<Texel<Format>>(at, across_of_, down_of_, weight);
  }

  /// `at(i, j)` gives the tap in column `i` and row `j`; `weight` makes those of taps.
  template <class Taps, class At, class Weights, class Weight>
  HWY_INLINE Taps sum_of_cubic(const At& at, const Weights& across, const Weights& down,
                               const Weight& weight) const {
    const auto x0 = weight(across[0]), x1 = weight(across[1]);
    const auto x2 = weight(across[2]), x3 = weight(across[3]);
    const Taps a = at(1, 1), b = at(2, 1), c = at(1, 2), d = at(2, 2);
    const Taps above = at(1, 0).times(x1).plus(at(2, 0), x2);
    const Taps upper = at(0, 1).times(x0).plus(a, x1).plus(b, x2).plus(at(3, 1), x3);
    const Taps lower = at(0, 2).times(x0).plus(c, x1).plus(d, x2).plus(at(3, 2), x3);
    const Taps below = at(1, 3).times(x1).plus(at(2, 3), x2);
    const Taps sum = above.times(weight(down[0]))
                         .plus(upper, weight(down[1]))
                         .plus(lower, weight(down[2]))
                         .plus(below, weight(down[3]));
    const Taps low = a.lesser(b).lesser(c.lesser(d)), high = a.greater(b).greater(c.greater(d));
    return sum.greater(low).lesser(high);
  }

  const D d_{};
  const DI di_{};
  int lanes_;
  bool static_;
  bool together_;
  const HistoryTaps<D>& taps_;
  V across_[4], down_[4];
  // Of each pixel; columns and rows from the one before the first tap.
  HWY_ALIGN int columns_[4][most_lanes], rows_[4][most_lanes];
  HWY_ALIGN float bilinear_of_[4][most_lanes], across_of_[4][most_lanes], down_of_[4][most_lanes];
  HWY_ALIGN float whole_[most_lanes];
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
