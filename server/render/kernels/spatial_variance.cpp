#include "render/kernels/spatial_variance.hpp"

#include <cmath>
#include <optional>

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/spatial_variance.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/denoise/moment_rows.hpp"
#include "render/kernels/simd/denoise/surface_plane.hpp"

#ifndef HELIOGRAPH_SPATIAL_VARIANCE_JOB
#define HELIOGRAPH_SPATIAL_VARIANCE_JOB
namespace heliograph::render::kernels {

struct SignalJob : SpatialVarianceJob {
  bool visibility;  // otherwise specular
};

}  // namespace heliograph::render::kernels
#endif

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D>
class SpatialVariance {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Rows = MomentRows<D>;

  static constexpr int radius = 3;
  // Of shaders/lib/denoise/spatial_variance.glsl
  static constexpr float enough_neighbours = 8.0f;
  static constexpr float nearby_depth = 0.02f;

  /// All exponents count octaves.
  struct Center {
    Triple<V> normal;
    SurfacePlane<V> plane;
    V inv_nearby;
  };
  struct Sums {
    Quad<V> moments;
    V total;
  };

 public:
  HWY_INLINE explicit SpatialVariance(const SignalJob& job)
      : job_(job), visibility_(job.visibility) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    std::optional<Rows> rows;  // most have long histories
    for (int y = first; y < last; ++y) {
      const ViewedRow<D> view(job_.frame, y);
      for (int start = 0; start < job_.width; start += lanes) {
        const int x = std::min(start, job_.width - lanes);
        const Quad<V> history = load_history4<Halves>(d_, job_.history_length, x, y);
        const Pair<V> frames{history.x, visibility_ ? history.y : history.x};
        const M brief =
            hn::Lt(hn::Min(frames.x, frames.y), set(job_.constants.spatial_variance_frames));
        const M requested = hn::And(brief, from_column(d_, x, start));
        if (hn::AllFalse(d_, requested)) continue;
        if (!rows) {
          rows.emplace(job_.guide, job_.moments, visibility_, job_.width, job_.height,
                       std::max(first - radius, 0), radius);
        }
        rows->advance(y);
        block(*rows, view, x, y, requested, frames);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  HWY_INLINE void block(const Rows& rows, const ViewedRow<D>& view, int x, int y, M requested,
                        const Pair<V>& frames) const {
    const Center c = center(rows, view, x, y);
    requested = hn::And(requested, hn::Gt(c.plane.view_z, hn::Zero(d_)));
    if (hn::AllFalse(d_, requested)) return;
    const Sums sums = gathered<false>(rows, c, x, y);
    requested = hn::And(requested, hn::Gt(sums.total, hn::Zero(d_)));
    const V one = set(1.0f);
    const V alone = clamped(
        (set(enough_neighbours) - sums.total) * set(1.0f / (enough_neighbours - 2.0f)), 0.0f, 1.0f);
    const V strict = one / sums.total;
    Quad<V> mean{sums.moments.x * strict, sums.moments.y * strict, sums.moments.z * strict,
                 sums.moments.w * strict};
    if (!hn::AllFalse(d_, hn::And(requested, hn::Gt(alone, hn::Zero(d_))))) {
      mean = mixed(mean, gathered<true>(rows, c, x, y), alone);
    }
    float* const signal = row_of<float>(job_.signal, y) + 4 * x;
    const Quad<V> value = load4(d_, signal);
    Quad<V> changed = value;
    if (visibility_) {
      changed.z = hn::Max(variance(mean.x, mean.z, frames.x), value.z);
      changed.w = hn::Max(variance(mean.y, mean.w, frames.y), value.w);
      changed.x = mixed(value.x, mean.x, alone / hn::Max(frames.x, one));
      changed.y = mixed(value.y, mean.y, alone / hn::Max(frames.y, one));
    } else {
      changed.w = hn::Max(variance(mean.z, mean.w, frames.x), value.w);
    }
    changed = select(requested, changed, value);
    store4(d_, changed, signal);
    if (visibility_) {
      // Where nothing is requested it gets what it holds.
      store_history4<Fractions>(d_, changed, Rounding<D>(x, y, job_.frame.sample_index),
                                job_.history, x, y);
    }
  }

  HWY_INLINE V mixed(V from, V to, V fraction) const {
    return hn::MulAdd(to - from, fraction, from);
  }
  HWY_INLINE Quad<V> mixed(const Quad<V>& mean, const Sums& loose, V alone) const {
    const V by = set(1.0f) / hn::Max(loose.total, set(1e-6f));
    return {mixed(mean.x, loose.moments.x * by, alone), mixed(mean.y, loose.moments.y * by, alone),
            mixed(mean.z, loose.moments.z * by, alone), mixed(mean.w, loose.moments.w * by, alone)};
  }

  HWY_INLINE V variance(V first, V second, V frames) const {
    const V one = set(1.0f), known = hn::Max(frames, one);
    const V longer = hn::Max(set(job_.constants.spatial_variance_frames) / known, one);
    const V spread = hn::Max(hn::NegMulAdd(first, first, second), hn::Zero(d_)) * longer;
    const bool of_mean = (job_.constants.flags & shared::temporal_mean_variance) != 0;
    return of_mean ? spread / known : spread;
  }

  HWY_INLINE Center center(const Rows& rows, const ViewedRow<D>& view, int x, int y) const {
    const float* const texels = rows.row(y) + x;
    Center c;
    c.normal = {rows.load(texels, Rows::normal_x), rows.load(texels, Rows::normal_y),
                rows.load(texels, Rows::normal_z)};
    const V z = rows.load(texels, Rows::view_z);
    c.plane = surface_plane(view, z, load2(d_, row_of<const float>(job_.depth_slope, y) + 2 * x));
    c.inv_nearby = set(octaves) / hn::Max(set(nearby_depth) * z, set(1e-30f));
    return c;
  }

  /// `loose`: of neighbours of other planes, too.
  template <bool loose>
  HWY_INLINE Sums gathered(const Rows& rows, const Center& c, int x, int y) const {
    const V zero = hn::Zero(d_);
    Sums sums{{zero, zero, zero, zero}, zero};
    for (int dy = -radius; dy <= radius; ++dy) {
      if (y + dy < 0 || y + dy >= job_.height) continue;
      for (int dx = -radius; dx <= radius; ++dx) {
        add_tap<loose>(rows, c, rows.row(y + dy) + x + dx, dx, dy, sums);
      }
    }
    return sums;
  }

  /// Weights of shaders/lib/denoise/edge_stopping.glsl
  template <bool loose>
  HWY_INLINE void add_tap(const Rows& rows, const Center& c, const float* texels, int dx, int dy,
                          Sums& sums) const {
    const auto plane = [&](int index) HWY_ATTR { return rows.load(texels, index); };
    const V z = plane(Rows::view_z);
    const M valid = hn::Gt(z, hn::Zero(d_));
    const V cosine = dot(
        c.normal, Triple<V>{plane(Rows::normal_x), plane(Rows::normal_y), plane(Rows::normal_z)});
    V weight;
    if constexpr (loose) {
      const V exponent = hn::NegMulAdd(hn::Abs(z - c.plane.view_z), c.inv_nearby, set(weight_one));
      weight = edge_weight(valid, exponent) * hn::Max(cosine, hn::Zero(d_));
    } else {
      const auto x = static_cast<float>(dx), y = static_cast<float>(dy);
      const V of_normal =
          hn::MulAdd(set(128.0f * octaves), cosine, set(weight_one - 128.0f * octaves));
      const V apart = set(std::sqrt(x * x + y * y));
      weight = edge_weight(valid, c.plane.lowered(of_normal, z, set(x), set(y), apart, 1.0f));
    }
    sums.moments.x = hn::MulAdd(weight, plane(Rows::moment), sums.moments.x);
    sums.moments.y = hn::MulAdd(weight, plane(Rows::moment + 1), sums.moments.y);
    sums.moments.z = hn::MulAdd(weight, plane(Rows::moment + 2), sums.moments.z);
    sums.moments.w = hn::MulAdd(weight, plane(Rows::moment + 3), sums.moments.w);
    sums.total = sums.total + weight;
  }

  const D d_{};
  const SignalJob& job_;
  bool visibility_;
};

void spatial_variance_rows(const SignalJob& job, int first, int last) {
  run_rows<SpatialVariance>(job, job.width, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(spatial_variance_rows);

namespace {

void estimate(const SignalJob& job) {
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(spatial_variance_rows)(job, first, last);
  });
}

}  // namespace

void visibility_variance(const SpatialVarianceJob& job) {
  estimate({job, true});
}

void specular_variance(const SpatialVarianceJob& job) {
  estimate({job, false});
}

}  // namespace heliograph::render::kernels
#endif
