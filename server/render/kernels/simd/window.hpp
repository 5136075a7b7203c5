// Texels of a few rows for lanes that read near each other, as neighbours do in the frame before:
// loaded side by side and picked in registers, where gathers take a load and more for every texel
// of every lane. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_WINDOW_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_WINDOW_HPP
#undef HELIOGRAPH_KERNELS_WINDOW_HPP
#else
#define HELIOGRAPH_KERNELS_WINDOW_HPP
#endif

#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Columns that every lane reads: two vectors of texels hold them all.
template <class D>
class ColumnWindow {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

 public:
  /// For columns `before` to the left of `x` to `after` to the right of it, clamped to a row of
  /// `width` texels.
  HWY_INLINE ColumnWindow(VI x, int before, int after, int width)
      : x_(x), width_(width), lanes_(static_cast<int>(hn::Lanes(d_))) {
    const int low = hn::GetLane(hn::MinOfLanes(di_, x)) - before;
    const int high = hn::GetLane(hn::MaxOfLanes(di_, x)) + after;
    first_ = std::max(std::min(low, width - 2 * lanes_), 0);
    fits_ = width >= 2 * lanes_ && std::min(high, width - 1) < first_ + 2 * lanes_;
  }

  /// Whether the lanes lie near enough to each other.
  bool fits() const { return fits_; }

  /// Three channels of four-channel texels.
  struct Row {
    Triple<V> low, high;
  };
  HWY_INLINE Row load(const float* row) const {
    const Quad<V> low = load4(d_, row + 4 * first_);
    const Quad<V> high = load4(d_, row + 4 * (first_ + lanes_));
    return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
  }

  /// Which texels of rows lie `away` columns from x.
  struct Pick {
    decltype(hn::IndicesFromVec(D(), hn::Zero(DI()))) index;
    hn::Mask<D> high;
  };
  HWY_INLINE Pick pick(int away) const {
    const VI column = hn::Add(x_, hn::Set(di_, away));
    const VI inside = hn::Min(hn::Max(column, hn::Zero(di_)), hn::Set(di_, width_ - 1));
    const VI at = hn::Sub(inside, hn::Set(di_, first_));
    const VI within = hn::And(at, hn::Set(di_, lanes_ - 1));
    return {hn::IndicesFromVec(d_, within),
            hn::RebindMask(d_, hn::Gt(at, hn::Set(di_, lanes_ - 1)))};
  }

  HWY_INLINE Triple<V> texels(const Row& row, const Pick& at) const {
    const auto channel = [&](V low, V high) HWY_ATTR {
      return hn::IfThenElse(at.high, hn::TableLookupLanes(high, at.index),
                            hn::TableLookupLanes(low, at.index));
    };
    return {channel(row.low.x, row.high.x), channel(row.low.y, row.high.y),
            channel(row.low.z, row.high.z)};
  }

 private:
  const D d_{};
  const DI di_{};
  VI x_;
  int width_;
  int lanes_;
  int first_;
  bool fits_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
