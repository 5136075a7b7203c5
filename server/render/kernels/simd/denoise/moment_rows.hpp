// Moments and surfaces about a row. Included once per instruction set; the guard is Google
// Highway's convention.
#if defined(HELIOGRAPH_KERNELS_MOMENT_ROWS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_MOMENT_ROWS_HPP
#undef HELIOGRAPH_KERNELS_MOMENT_ROWS_HPP
#else
#define HELIOGRAPH_KERNELS_MOMENT_ROWS_HPP
#endif

#include "render/kernels/common/row_ring.hpp"
#include "render/kernels/simd/denoise/history_texels.hpp"
#include "render/kernels/simd/guide.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Rows of the guide and of a signal's moments up to `reach` pixels away, in planes. View Z is 0
/// beyond the left and right edges of the frame.
template <class D>
class MomentRows {
  using V = hn::Vec<D>;

 public:
  enum Plane { normal_x, normal_y, normal_z, view_z, moment, planes = moment + 4 };

  /// `visibility`: `moments` holds them, otherwise mean and deviation of reflections (zw).
  MomentRows(const gpu::HostView& guide, const gpu::HostView& moments, bool visibility, int width,
             int height, int first, int reach)
      : guide_(guide),
        moments_(moments),
        visibility_(visibility),
        width_(width),
        height_(height),
        reach_(reach),
        next_(first),
        ring_(planes, width, reach, 2 * reach + 1) {}

  /// Makes row `y` and those within reach available, not before those of a smaller `y`.
  HWY_INLINE void advance(int y) {
    next_ = std::max(next_, y - reach_);
    for (; next_ <= std::min(y + reach_, height_ - 1); ++next_) fill(next_);
  }

  /// The first plane of row `y`.
  HWY_INLINE const float* row(int y) const { return ring_.row(y); }
  HWY_INLINE V load(const float* texels, int plane) const {
    return hn::LoadU(d_, texels + plane * ring_.pitch());
  }

 private:
  HWY_INLINE void fill(int y) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int i = 0; i < width_; i += lanes) {
      const int x = std::min(i, width_ - lanes);
      const auto surface = decode_guide(load4(d_, row_of<const float>(guide_, y) + 4 * x));
      const Quad<V> t = moments_at(x, y);
      const V values[planes]{
          surface.normal.x, surface.normal.y, surface.normal.z, surface.view_z, t.x, t.y, t.z, t.w};
      float* const to = ring_.row(y) + x;
      for (int plane = 0; plane < planes; ++plane) {
        hn::StoreU(values[plane], d_, to + plane * ring_.pitch());
      }
    }
  }

  HWY_INLINE Quad<V> moments_at(int x, int y) const {
    return visibility_ ? load_history4<Fractions>(d_, moments_, x, y)
                       : load_history4<MeanAndDeviation>(d_, moments_, x, y);
  }

  const D d_{};
  gpu::HostView guide_, moments_;
  bool visibility_;
  int width_;
  int height_;
  int reach_;
  int next_;  // row that is not there yet
  RowRing ring_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
