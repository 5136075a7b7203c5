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

/// What is read with a row: columns beside the area, which show no surface, and rows.
struct RowReach {
  int columns, above, below;
};

/// Planes of the newest rows of an area. The normals are unit vectors. `visibility`: the signal is
/// that of shaders/lib/denoise/visibility_signal.glsl, otherwise of specular_signal.glsl.
template <class D, bool visibility>
class SignalRows {
  using V = hn::Vec<D>;

 public:
  /// Of the guide, then of the signal: its four channels, and the brightness of reflections.
  enum Plane { normal_x, normal_y, normal_z, roughness, view_z, signal };
  static constexpr int signal_planes = visibility ? 4 : 5;
  /// Planes of another signal, which the reader of the rows writes, come after the first.
  static constexpr int second_signal = signal + signal_planes;
  static constexpr int variance = visibility ? 2 : 3;  // the plane of a signal
  static constexpr int variances = visibility ? 2 : 1;

  /// The rows of the area and above it from `area.top` on are needed; at least one row above and
  /// below is. `signals`: 1, or 2 with the second.
  SignalRows(const gpu::HostView& guide, const gpu::HostView& from, int frame_width,
             int frame_height, const Area& area, const RowReach& reach, int signals = 1)
      : guide_(guide),
        signal_(from),
        width_(frame_width),
        height_(frame_height),
        area_(area),
        reach_(reach),
        next_(area.top),
        ring_(signal + signals * signal_planes, area.width(), reach.columns,
              reach.above + reach.below + 1),
        sums_(variances, area.width(), 1, 1) {}

  /// Makes row `y` and those within the reach available, not before those of a smaller `y`.
  HWY_INLINE void advance(int y) {
    next_ = std::max(next_, y - reach_.above);
    for (; next_ <= std::min(y + reach_.below, height_ - 1); ++next_) {
      if (area_.width() < width_) prefetch(std::min(next_ + 2, height_ - 1));
      fill(next_);
    }
  }

  const Area& area() const { return area_; }
  /// The first plane of row `y` at the area's first column.
  HWY_INLINE const float* row(int y) const { return ring_.row(y); }
  HWY_INLINE V load(const float* texels, int plane) const {
    return hn::LoadU(d_, texels + plane * ring_.pitch());
  }

  /// Writes texels of the second signal.
  HWY_INLINE void store_second(const Quad<V>& value, int x, int y) const {
    store_signal(value, ring_.row(y) + x - area_.left + second_signal * ring_.pitch());
  }
  /// Completes a row of it: beyond the frame's edges its variance is that at the edges.
  HWY_INLINE void extend_second(int y) const {
    for (int i = 0; i < variances; ++i) {
      float* const row = ring_.row(y) + (second_signal + variance + i) * ring_.pitch();
      if (area_.left == 0) row[-1] = row[0];
      if (area_.right == width_) row[area_.width()] = row[area_.width() - 1];
    }
  }

  /// Sums of the variance down the rows about `y`, weights 1 2 1, of the signal that begins with
  /// `first_plane`, for smooth_variance() of the columns `left` to `right`.
  HWY_INLINE void add_variance_rows(int first_plane, int left, int right, int y) const {
    const float* const above = ring_.row(std::max(y - 1, 0));
    const float* const here = ring_.row(y);
    const float* const below = ring_.row(std::min(y + 1, height_ - 1));
    const int lanes = static_cast<int>(hn::Lanes(d_)), end = right - area_.left + 1;
    for (int i = 0; i < variances; ++i) {
      float* const sums = sums_.row(0) + i * sums_.pitch();
      const int plane = (first_plane + variance + i) * ring_.pitch();
      for (int column = left - area_.left - 1; column < end; column += lanes) {
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
    const float* const from = row_of<const float>(signal_, y);
    for (int i = area_.left; i < area_.right; i += lanes) {
      const int x = std::min(i, area_.right - lanes);
      fill_block(guide + 4 * x, from + 4 * x, row + x - area_.left);
    }
    // What variance is smoothed with beside the area; at the frame's edges the outermost.
    const int before = std::max(area_.left - 1, 0), behind = std::min(area_.right, width_ - 1);
    for (int i = 0; i < variances; ++i) {
      float* const to = row + (signal + variance + i) * ring_.pitch();
      to[-1] = from[4 * before + variance + i];
      to[area_.width()] = from[4 * behind + variance + i];
    }
  }

  HWY_INLINE void store(V value, float* to, int plane) const {
    hn::StoreU(value, d_, to + plane * ring_.pitch());
  }
  HWY_INLINE void store_signal(const Quad<V>& value, float* to) const {
    store(value.x, to, 0);
    store(value.y, to, 1);
    store(value.z, to, 2);
    store(value.w, to, 3);
    if constexpr (!visibility) {
      store(luminance(Triple<V>{value.x, value.y, value.z}), to, 4);
    }
  }
  HWY_INLINE void fill_block(const float* guide, const float* from, float* to) const {
    const Quad<V> texel = load4(d_, guide);
    const Triple<V> scaled{texel.x, texel.y, texel.z};
    const V square = hn::Max(dot(scaled, scaled), hn::Set(d_, 1e-12f));
    const V inv_length = reciprocal_sqrt(square);
    store(texel.x * inv_length, to, normal_x);
    store(texel.y * inv_length, to, normal_y);
    store(texel.z * inv_length, to, normal_z);
    store(hn::MulSub(square, inv_length, hn::Set(d_, 1.0f)), to, roughness);
    store(texel.w, to, view_z);
    store_signal(load4(d_, from), to + signal * ring_.pitch());
  }

  const D d_{};
  gpu::HostView guide_, signal_;
  int width_, height_;  // of the frame
  Area area_;
  RowReach reach_;
  int next_;  // row that is not there yet
  RowRing ring_;
  RowRing sums_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
