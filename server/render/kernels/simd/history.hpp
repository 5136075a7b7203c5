// Reading the frame before in host kernels: shaders/lib/denoise/reprojection.glsl in vectors.
// Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_HISTORY_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_HISTORY_HPP
#undef HELIOGRAPH_KERNELS_HISTORY_HPP
#else
#define HELIOGRAPH_KERNELS_HISTORY_HPP
#endif

#include "render/kernels/simd/pixels.hpp"
#include "shaders/shared/denoise.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// One pixel per lane, inside the frame. Neighbours mostly move together: where they lie side by
/// side they are loaded, otherwise gathered.
template <class D>
class TexelGather {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

 public:
  HWY_INLINE TexelGather(VI x, VI y)
      : x_(x), y_(y), first_x_(hn::GetLane(x)), first_y_(hn::GetLane(y)) {
    const auto beside =
        hn::And(hn::Eq(x, hn::Iota(di_, first_x_)), hn::Eq(y, hn::Set(di_, first_y_)));
    together_ = hn::AllTrue(di_, beside);
  }

  HWY_INLINE V one(const gpu::HostView& image) const {
    if (together_) return hn::LoadU(d_, row_of<const float>(image, first_y_) + first_x_);
    return hn::GatherIndex(d_, row_of<const float>(image, 0), index<1>(image));
  }
  HWY_INLINE VI word(const gpu::HostView& image) const {
    if (together_) return hn::LoadU(di_, row_of<const int>(image, first_y_) + first_x_);
    return hn::GatherIndex(di_, row_of<const int>(image, 0), index<1>(image));
  }
  HWY_INLINE Pair<V> two(const gpu::HostView& image) const {
    if (together_) return load2(d_, row_of<const float>(image, first_y_) + 2 * first_x_);
    const float* const texels = row_of<const float>(image, 0);
    const VI at = index<2>(image);
    return {hn::GatherIndex(d_, texels, at), hn::GatherIndex(d_, texels + 1, at)};
  }
  HWY_INLINE Quad<V> four(const gpu::HostView& image) const {
    if (together_) return load4(d_, row_of<const float>(image, first_y_) + 4 * first_x_);
    return gather4(d_, row_of<const float>(image, 0), index<4>(image));
  }
  HWY_INLINE Triple<V> first_three(const gpu::HostView& image) const {
    if (!together_) return gather3(d_, row_of<const float>(image, 0), index<4>(image));
    const Quad<V> t = load4(d_, row_of<const float>(image, first_y_) + 4 * first_x_);
    return {t.x, t.y, t.z};
  }
  /// The first two channels of four.
  HWY_INLINE Pair<V> first_two(const gpu::HostView& image) const {
    if (together_) {
      const Quad<V> t = load4(d_, row_of<const float>(image, first_y_) + 4 * first_x_);
      return {t.x, t.y};
    }
    const float* const texels = row_of<const float>(image, 0);
    const VI at = index<4>(image);
    return {hn::GatherIndex(d_, texels, at), hn::GatherIndex(d_, texels + 1, at)};
  }
  HWY_INLINE V last_of_four(const gpu::HostView& image) const {
    if (together_) return load4(d_, row_of<const float>(image, first_y_) + 4 * first_x_).w;
    return hn::GatherIndex(d_, row_of<const float>(image, 0) + 3, index<4>(image));
  }

 private:
  /// In words of 32 bits, `channels` to a texel.
  template <int channels>
  HWY_INLINE VI index(const gpu::HostView& image) const {
    const auto pitch = static_cast<int>(image.row_pitch / sizeof(float));
    return hn::Mul(y_, hn::Set(di_, pitch)) + hn::Mul(x_, hn::Set(di_, channels));
  }

  const D d_{};
  const DI di_{};
  VI x_, y_;
  int first_x_, first_y_;
  bool together_;
};

/// The size of a frame, and which pixels are inside.
template <class D>
class Bounds {
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

 public:
  Bounds(int width, int height) : width_(width), height_(height) {}

  /// The nearest pixel inside.
  HWY_INLINE TexelGather<D> gather(VI x, VI y) const {
    return TexelGather<D>(clamped(x, width_), clamped(y, height_));
  }
  HWY_INLINE hn::Mask<D> contain(VI x, VI y) const {
    return hn::RebindMask(D(),
                          hn::And(hn::Eq(x, clamped(x, width_)), hn::Eq(y, clamped(y, height_))));
  }

 private:
  static HWY_INLINE VI clamped(VI v, int size) {
    const DI di;
    return hn::Min(hn::Max(v, hn::Zero(di)), hn::Set(di, size - 1));
  }

  int width_;
  int height_;
};

/// Four neighbouring pixels of the frame before: bilinear weights about a position in pixels, whose
/// centres are at one half.
template <class D>
struct HistoryTaps {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

  VI x, y;
  V weights[4];              // of (x, y), right of it, below it, below and right
  V fraction_x, fraction_y;  // from (x, y) to the last of them
  hn::Mask<D> whole;         // no pixel with a weight is invalid

  HWY_INLINE HistoryTaps(V position_x, V position_y) {
    const D d;
    const DI di;
    const V one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    // What lies far outside is nowhere, and the index stays a number.
    const V corner_x = clamped(position_x - half, -1e6f, 1e6f);
    const V corner_y = clamped(position_y - half, -1e6f, 1e6f);
    const V low_x = hn::Floor(corner_x), low_y = hn::Floor(corner_y);
    const V fx = corner_x - low_x, fy = corner_y - low_y;
    x = hn::ConvertTo(di, low_x);
    y = hn::ConvertTo(di, low_y);
    weights[0] = (one - fx) * (one - fy);
    weights[1] = fx * (one - fy);
    weights[2] = (one - fx) * fy;
    weights[3] = fx * fy;
    fraction_x = fx;
    fraction_y = fy;
    whole = hn::Ge(fx, hn::Zero(d));
  }

  HWY_INLINE VI tap_x(int tap) const { return x + hn::Set(DI(), tap & 1); }
  HWY_INLINE VI tap_y(int tap) const { return y + hn::Set(DI(), tap >> 1); }

  /// Leaves a tap out where it is not valid.
  HWY_INLINE void keep(int tap, hn::Mask<D> valid) {
    const auto missing = hn::AndNot(valid, hn::Gt(weights[tap], hn::Zero(D())));
    whole = hn::AndNot(missing, whole);
    weights[tap] = hn::IfThenElseZero(valid, weights[tap]);
  }
  /// Renormalises the weights; all 0 where their sum is less than min_tap_weight_sum.
  HWY_INLINE void normalise() {
    const D d;
    const V sum = weights[0] + weights[1] + weights[2] + weights[3];
    const auto enough = hn::Ge(sum, hn::Set(d, shared::min_tap_weight_sum));
    const V scale = hn::IfThenElseZero(enough, hn::Set(d, 1.0f) / sum);
    for (V& weight : weights) weight = weight * scale;
  }
  HWY_INLINE hn::Mask<D> any() const {
    const D d;
    return hn::Gt(weights[0] + weights[1] + weights[2] + weights[3], hn::Zero(d));
  }
};

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
class Texel {
  using Tag = hn::CappedTag<float, 4>;
  using V = hn::Vec<Tag>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int parts = 4 / lanes;

 public:
  static HWY_INLINE Texel load(const float* from) {
    Texel t;
    for (int i = 0; i < parts; ++i) t.part_[i] = hn::LoadU(Tag(), from + i * lanes);
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

/// Reads rgba32f images of the frame before. Pixels move by different amounts, so that vectors of
/// pixels would have to gather each channel of each tap: here a vector holds the channels, and
/// pixels take turns. Images must be finite, for taps without a weight are read, too.
template <class D>
class HistoryReader {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;
  static constexpr int most_lanes = static_cast<int>(hn::MaxLanes(D()));

 public:
  HWY_INLINE HistoryReader(const HistoryTaps<D>& taps, int width, int height)
      : lanes_(static_cast<int>(hn::Lanes(d_))) {
    const V zero = hn::Zero(d_);
    // A position on a pixel's centre concerns no other column or row.
    place(taps.x, hn::Gt(taps.fraction_x, zero), width, columns_);
    place(taps.y, hn::Gt(taps.fraction_y, zero), height, rows_);
    for (int i = 0; i < 4; ++i) hn::StoreU(taps.weights[i], d_, bilinear_[i]);
    hn::StoreU(hn::IfThenElseZero(taps.whole, hn::Set(d_, 1.0f)), d_, whole_);
    V across[4], down[4];
    cubic_weights(taps.fraction_x, across);
    cubic_weights(taps.fraction_y, down);
    // Without the corners, whose weights are next to nothing.
    const V one = hn::Set(d_, 1.0f);
    const V scale = one / hn::NegMulAdd(across[0] + across[3], down[0] + down[3], one);
    for (int i = 0; i < 4; ++i) {
      hn::StoreU(across[i], d_, across_[i]);
      hn::StoreU(down[i] * scale, d_, down_[i]);
    }
    const bool same_row = hn::AllTrue(di_, hn::Eq(taps.y, hn::Set(di_, hn::GetLane(taps.y))));
    const bool in_order = hn::AllTrue(di_, hn::Eq(taps.x, hn::Iota(di_, hn::GetLane(taps.x))));
    static_ = same_row && in_order && hn::AllTrue(d_, hn::Eq(taps.weights[0], one));
  }

  /// The mean of the taps.
  HWY_INLINE Quad<V> bilinear(const gpu::HostView& image) const {
    if (static_) return load4(d_, texel(image, 0, 1, 1));
    return read([&](int lane) HWY_ATTR { return mean(image, lane); });
  }
  /// fetch_history_bicubic() of the shaders where all taps are valid, the mean elsewhere.
  HWY_INLINE Quad<V> bicubic(const gpu::HostView& image) const {
    if (static_) return load4(d_, texel(image, 0, 1, 1));
    return read([&](int lane) HWY_ATTR {
      return whole_[lane] != 0.0f ? cubic(image, lane) : mean(image, lane);
    });
  }

 private:
  HWY_INLINE void place(VI first, hn::Mask<D> between, int size, int (&to)[4][most_lanes]) const {
    const VI next = hn::IfThenElse(hn::RebindMask(di_, between), hn::Set(di_, 1), hn::Zero(di_));
    const VI steps[] = {hn::Set(di_, -1), hn::Zero(di_), next, hn::Set(di_, 2)};
    for (int i = 0; i < 4; ++i) {
      const VI at = hn::Min(hn::Max(first + steps[i], hn::Zero(di_)), hn::Set(di_, size - 1));
      hn::StoreU(at, di_, to[i]);
    }
  }
  HWY_INLINE const float* texel(const gpu::HostView& image, int lane, int i, int j) const {
    return row_of<const float>(image, rows_[j][lane]) + 4 * columns_[i][lane];
  }

  template <class Value>
  HWY_INLINE Quad<V> read(const Value& value) const {
    HWY_ALIGN float texels[4 * most_lanes];
    for (int lane = 0; lane < lanes_; ++lane) value(lane).store(texels + 4 * lane);
    return load4(d_, texels);
  }

  HWY_INLINE Texel mean(const gpu::HostView& image, int lane) const {
    Texel sum = Texel::load(texel(image, lane, 1, 1)).times(bilinear_[0][lane]);
    sum = sum.plus(Texel::load(texel(image, lane, 2, 1)), bilinear_[1][lane]);
    sum = sum.plus(Texel::load(texel(image, lane, 1, 2)), bilinear_[2][lane]);
    return sum.plus(Texel::load(texel(image, lane, 2, 2)), bilinear_[3][lane]);
  }

  HWY_INLINE Texel cubic(const gpu::HostView& image, int lane) const {
    const auto at = [&](int i, int j) HWY_ATTR { return Texel::load(texel(image, lane, i, j)); };
    const float x0 = across_[0][lane], x1 = across_[1][lane];
    const float x2 = across_[2][lane], x3 = across_[3][lane];
    const Texel a = at(1, 1), b = at(2, 1), c = at(1, 2), d = at(2, 2);
    const Texel above = at(1, 0).times(x1).plus(at(2, 0), x2);
    const Texel upper = at(0, 1).times(x0).plus(a, x1).plus(b, x2).plus(at(3, 1), x3);
    const Texel lower = at(0, 2).times(x0).plus(c, x1).plus(d, x2).plus(at(3, 2), x3);
    const Texel below = at(1, 3).times(x1).plus(at(2, 3), x2);
    const Texel sum = above.times(down_[0][lane])
                          .plus(upper, down_[1][lane])
                          .plus(lower, down_[2][lane])
                          .plus(below, down_[3][lane]);
    const Texel low = a.lesser(b).lesser(c.lesser(d)), high = a.greater(b).greater(c.greater(d));
    return sum.greater(low).lesser(high);
  }

  const D d_{};
  const DI di_{};
  int lanes_;
  bool static_;
  // Of each pixel; columns and rows from the one before the first tap.
  HWY_ALIGN int columns_[4][most_lanes], rows_[4][most_lanes];
  HWY_ALIGN float bilinear_[4][most_lanes], across_[4][most_lanes], down_[4][most_lanes];
  HWY_ALIGN float whole_[most_lanes];
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
