// Rows of a signal and of its guide, taken apart into planes once for all who read them. Included
// once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_SIGNAL_ROWS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_SIGNAL_ROWS_HPP
#undef HELIOGRAPH_KERNELS_SIGNAL_ROWS_HPP
#else
#define HELIOGRAPH_KERNELS_SIGNAL_ROWS_HPP
#endif

#include <algorithm>

#include "hwy/cache_control.h"
#include "render/kernels/common/area.hpp"
#include "render/kernels/common/row_ring.hpp"
#include "render/kernels/simd/edge_stopping.hpp"
#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Planes of the newest rows of an area. The normals are unit vectors. `visibility`: the signal is
/// that of shaders/lib/denoise/visibility_signal.glsl, otherwise of specular_signal.glsl.
template <class D, bool visibility>
class SignalRows {
  using V = hn::Vec<D>;

 public:
  enum Plane { normal_x, normal_y, normal_z, roughness, view_z, channels, brightness = 9 };
  static constexpr int variance = visibility ? channels + 2 : channels + 3;
  static constexpr int variances = visibility ? 2 : 1;

  /// `margin`: columns beside the area that are read; they show no surface. `reach`: rows above and
  /// below a row that are read with it, at least 1.
  SignalRows(const gpu::HostView& guide, const gpu::HostView& signal, int frame_width,
             int frame_height, const Area& area, int margin, int reach)
      : guide_(guide),
        signal_(signal),
        width_(frame_width),
        height_(frame_height),
        area_(area),
        reach_(reach),
        next_(std::max(area.top - reach, 0)),
        ring_(planes, area.width(), margin, 2 * reach + 1),
        sums_(variances, area.width(), 1, 1) {}

  /// Makes row `y` and those within the reach available, not before those of a smaller `y`.
  HWY_INLINE void advance(int y) {
    next_ = std::max(next_, y - reach_);
    for (; next_ <= std::min(y + reach_, height_ - 1); ++next_) {
      if (area_.width() < width_) prefetch(std::min(next_ + 2, height_ - 1));
      fill(next_);
    }
  }

  /// The first plane of row `y` at the area's first column.
  HWY_INLINE const float* row(int y) const { return ring_.row(y); }
  HWY_INLINE V load(const float* texels, int plane) const {
    return hn::LoadU(d_, texels + plane * ring_.pitch());
  }

  /// Sums of the variance down the rows about `y`, weights 1 2 1.
  HWY_INLINE void add_variance_rows(int y) const {
    const float* const above = ring_.row(std::max(y - 1, 0));
    const float* const here = ring_.row(y);
    const float* const below = ring_.row(std::min(y + 1, height_ - 1));
    const int lanes = static_cast<int>(hn::Lanes(d_)), end = area_.width() + 1;
    for (int i = 0; i < variances; ++i) {
      float* const sums = sums_.row(0) + i * sums_.pitch();
      const int plane = (variance + i) * ring_.pitch();
      for (int column = -1; column < end; column += lanes) {
        const int x = std::min(column, end - lanes);
        const V middle = hn::LoadU(d_, here + plane + x);
        const V outer = hn::LoadU(d_, above + plane + x) + hn::LoadU(d_, below + plane + x);
        hn::StoreU(hn::MulAdd(middle, hn::Set(d_, 2.0f), outer), d_, sums + x);
      }
    }
  }
  /// Variance over 3x3 pixels in the row of those sums.
  HWY_INLINE V smooth_variance(int column, int i) const {
    const float* const sums = sums_.row(0) + i * sums_.pitch() + column;
    const V outer = hn::LoadU(d_, sums - 1) + hn::LoadU(d_, sums + 1);
    return hn::MulAdd(hn::LoadU(d_, sums), hn::Set(d_, 2.0f), outer) * hn::Set(d_, 1.0f / 16.0f);
  }

 private:
  static constexpr int planes = visibility ? brightness : brightness + 1;

  /// Of a part of a row the processor does not expect the next row.
  HWY_INLINE void prefetch(int y) const {
    constexpr int line = 4;  // texels
    for (int x = area_.left; x < area_.right; x += line) {
      hwy::Prefetch(row_of<const float>(guide_, y) + 4 * x);
      hwy::Prefetch(row_of<const float>(signal_, y) + 4 * x);
    }
  }

  HWY_INLINE void fill(int y) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    float* const row = ring_.row(y);
    const float* const guide = row_of<const float>(guide_, y);
    const float* const signal = row_of<const float>(signal_, y);
    for (int i = area_.left; i < area_.right; i += lanes) {
      const int x = std::min(i, area_.right - lanes);
      fill_block(guide + 4 * x, signal + 4 * x, row + x - area_.left);
    }
    // What variance is smoothed with beside the area; at the frame's edges the outermost.
    const int before = std::max(area_.left - 1, 0), behind = std::min(area_.right, width_ - 1);
    for (int i = 0; i < variances; ++i) {
      float* const to = row + (variance + i) * ring_.pitch();
      const int channel = variance - channels + i;
      to[-1] = signal[4 * before + channel];
      to[area_.width()] = signal[4 * behind + channel];
    }
  }

  HWY_INLINE void fill_block(const float* guide, const float* signal, float* to) const {
    const auto store = [&](int plane, V v)
                           HWY_ATTR { hn::StoreU(v, d_, to + plane * ring_.pitch()); };
    const Quad<V> texel = load4(d_, guide);
    const Triple<V> scaled{texel.x, texel.y, texel.z};
    const V square = hn::Max(dot(scaled, scaled), hn::Set(d_, 1e-12f));
    const V inv_length = reciprocal_sqrt(square);
    store(normal_x, texel.x * inv_length);
    store(normal_y, texel.y * inv_length);
    store(normal_z, texel.z * inv_length);
    store(roughness, hn::MulSub(square, inv_length, hn::Set(d_, 1.0f)));
    store(view_z, texel.w);
    const Quad<V> value = load4(d_, signal);
    store(channels, value.x);
    store(channels + 1, value.y);
    store(channels + 2, value.z);
    store(channels + 3, value.w);
    if constexpr (!visibility) {
      store(brightness, luminance(Triple<V>{value.x, value.y, value.z}));
    }
  }

  const D d_{};
  gpu::HostView guide_, signal_;
  int width_, height_;  // of the frame
  Area area_;
  int reach_;
  int next_;  // row that is not there yet
  RowRing ring_;
  RowRing sums_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
