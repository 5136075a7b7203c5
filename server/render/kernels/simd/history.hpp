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
  HWY_INLINE Pair<V> two_halves(const gpu::HostView& image) const { return halves(word(image)); }
  /// The first or second two channels of four half floats, or of four fractions.
  template <int second>
  HWY_INLINE Pair<V> half_of_four_halves(const gpu::HostView& image) const {
    return halves(half_of_four<second>(image));
  }
  template <int second>
  HWY_INLINE Pair<V> half_of_four_fractions(const gpu::HostView& image) const {
    const VI words = half_of_four<second>(image);
    const V unit = hn::Set(d_, 1.0f / 65535.0f);
    return {hn::ConvertTo(d_, hn::And(words, hn::Set(di_, 0xffff))) * unit,
            hn::ConvertTo(d_, hn::And(hn::ShiftRight<16>(words), hn::Set(di_, 0xffff))) * unit};
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
  HWY_INLINE Pair<V> halves(VI words) const {
    const auto bits = hn::BitCast(hn::RebindToUnsigned<D>(), words);
    return {half_float(d_, bits), half_float(d_, hn::ShiftRight<16>(bits))};
  }
  template <int second>
  HWY_INLINE VI half_of_four(const gpu::HostView& image) const {
    if (together_) {
      VI first_words, second_words;
      hn::LoadInterleaved2(di_, row_of<const int>(image, first_y_) + 2 * first_x_, first_words,
                           second_words);
      return second ? second_words : first_words;
    }
    return hn::GatherIndex(di_, row_of<const int>(image, 0) + second, index<2>(image));
  }
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

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
