#include "render/kernels/spatial_variance.hpp"

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/spatial_variance.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/guide.hpp"
#include "render/kernels/simd/history.hpp"
#include "render/kernels/simd/view.hpp"

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
  using DI = hn::RebindToSigned<D>;

  static constexpr int radius = 3;
  // Of shaders/lib/denoise/spatial_variance.glsl
  static constexpr float enough_neighbours = 8.0f;
  static constexpr float nearby_depth = 0.02f;

  struct Center {
    Triple<V> normal;
    V view_z;
    Pair<V> slope;
    V curve;      // 1 / Z, 0 in orthographic views
    V flattened;  // 1 - Z * curve
    V footprint;  // half of a pixel's
  };
  struct Sums {
    Quad<V> moments;
    V total;
    Quad<V> loose_moments;  // of neighbours of other planes, too
    V loose_total;
  };

 public:
  HWY_INLINE explicit SpatialVariance(const SignalJob& job)
      : job_(job),
        visibility_(job.visibility),
        orthographic_((job.frame.flags & shared::frame_orthographic) != 0),
        bounds_(job.width, job.height) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      const ViewedRow<D> view(job_.frame, y);
      for (int x = 0; x < job_.width; x += lanes) {
        block(view, std::min(x, job_.width - lanes), y, x);
      }
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  HWY_INLINE Quad<V> load(const gpu::HostView& image, int x, int y) const {
    return load4(d_, row_of<const float>(image, y) + 4 * x);
  }

  /// Pixels from `start` on; those before are done.
  HWY_INLINE void block(const ViewedRow<D>& view, int x, int y, int start) const {
    const Quad<V> history = load(job_.history_length, x, y);
    const V frames_x = history.x, frames_y = visibility_ ? history.y : history.x;
    const Quad<V> guide = load(job_.guide, x, y);
    const V enough = set(job_.constants.spatial_variance_frames);
    M requested = hn::And(guide_is_surface(guide), hn::Lt(hn::Min(frames_x, frames_y), enough));
    requested = hn::And(requested, from_column(d_, x, start));
    if (hn::AllFalse(d_, requested)) return;
    const Sums sums = gathered(center(view, guide, x, y), x, y);
    requested = hn::And(requested, hn::Gt(sums.total, hn::Zero(d_)));
    const V one = set(1.0f);
    const V alone = clamped(
        (set(enough_neighbours) - sums.total) * set(1.0f / (enough_neighbours - 2.0f)), 0.0f, 1.0f);
    const Quad<V> mean = mixed(sums, alone);
    float* const signal = row_of<float>(job_.signal, y) + 4 * x;
    const Quad<V> value = load4(d_, signal);
    Quad<V> changed = value;
    if (visibility_) {
      changed.z = hn::Max(variance(mean.x, mean.z, frames_x), value.z);
      changed.w = hn::Max(variance(mean.y, mean.w, frames_y), value.w);
      changed.x = mixed(value.x, mean.x, alone / hn::Max(frames_x, one));
      changed.y = mixed(value.y, mean.y, alone / hn::Max(frames_y, one));
    } else {
      changed.w = hn::Max(variance(mean.z, mean.w, frames_x), value.w);
    }
    store4(d_, select(requested, changed, value), signal);
  }

  HWY_INLINE V mixed(V from, V to, V fraction) const {
    return hn::MulAdd(to - from, fraction, from);
  }
  HWY_INLINE Quad<V> mixed(const Sums& sums, V alone) const {
    const V strict = set(1.0f) / sums.total;
    const V loose = set(1.0f) / hn::Max(sums.loose_total, set(1e-6f));
    const auto mean = [&](V of_plane, V of_all) {
      return mixed(of_plane * strict, of_all * loose, alone);
    };
    return {mean(sums.moments.x, sums.loose_moments.x), mean(sums.moments.y, sums.loose_moments.y),
            mean(sums.moments.z, sums.loose_moments.z), mean(sums.moments.w, sums.loose_moments.w)};
  }

  HWY_INLINE V variance(V first, V second, V frames) const {
    const V one = set(1.0f), known = hn::Max(frames, one);
    const V longer = hn::Max(set(job_.constants.spatial_variance_frames) / known, one);
    const V spread = hn::Max(hn::NegMulAdd(first, first, second), hn::Zero(d_)) * longer;
    const bool of_mean = (job_.constants.flags & shared::temporal_mean_variance) != 0;
    return of_mean ? spread / known : spread;
  }

  HWY_INLINE Center center(const ViewedRow<D>& view, const Quad<V>& guide, int x, int y) const {
    Center c;
    c.normal = decode_guide(guide).normal;
    c.view_z = guide.w;
    c.slope = load2(d_, row_of<const float>(job_.depth_slope, y) + 2 * x);
    c.curve = orthographic_ ? hn::Zero(d_) : set(1.0f) / hn::Max(guide.w, set(1e-20f));
    c.flattened = hn::NegMulAdd(c.view_z, c.curve, set(1.0f));
    c.footprint = set(0.5f) * view.footprint(guide.w);
    return c;
  }

  HWY_INLINE Sums gathered(const Center& c, int x, int y) const {
    const V zero = hn::Zero(d_);
    const Quad<V> none{zero, zero, zero, zero};
    Sums sums{none, zero, none, zero};
    const int lanes = static_cast<int>(hn::Lanes(d_));
    const bool inside = x >= radius && x + lanes + radius <= job_.width;
    for (int dy = -radius; dy <= radius; ++dy) {
      if (y + dy < 0 || y + dy >= job_.height) continue;
      for (int dx = -radius; dx <= radius; ++dx) {
        if (inside) {
          add_tap(c, dx, dy, load(job_.guide, x + dx, y + dy), load(job_.moments, x + dx, y + dy),
                  from_column(d_, x, x), sums);
        } else {
          const auto column = hn::Iota(DI(), x + dx), row = hn::Set(DI(), y + dy);
          const TexelGather<D> texels = bounds_.gather(column, row);
          add_tap(c, dx, dy, texels.four(job_.guide), texels.four(job_.moments),
                  bounds_.contain(column, row), sums);
        }
      }
    }
    return sums;
  }

  /// Weights of shaders/lib/denoise/edge_stopping.glsl
  HWY_INLINE void add_tap(const Center& c, int dx, int dy, const Quad<V>& guide,
                          const Quad<V>& moments, M inside, Sums& sums) const {
    const M valid = hn::And(inside, guide_is_surface(guide));
    const float away = std::sqrt(static_cast<float>(dx * dx + dy * dy));
    const V rise =
        hn::MulAdd(c.slope.x, set(static_cast<float>(dx)), c.slope.y * set(static_cast<float>(dy)));
    const V straight = hn::NegMulAdd(rise, c.curve, set(1.0f));
    const V off_plane =
        hn::Abs(hn::NegMulAdd(rise, c.flattened, hn::MulSub(guide.w, straight, c.view_z)));
    const V allowed = hn::MulAdd(c.footprint, set(away), hn::Abs(rise));
    const V zero = hn::Zero(d_);
    const V cosine = guide_cosine(c.normal, guide);
    const V exponent = hn::MulAdd(set(128.0f), hn::Log(d_, clamped(cosine, 1e-6f, 1.0f)),
                                  hn::Neg(off_plane / hn::Max(allowed, set(1e-30f))));
    // Below e^-80 a weight is nothing; the exponential stays in its range.
    const V weight = hn::IfThenElseZero(valid, hn::Exp(d_, hn::Max(exponent, set(-80.0f))));
    add(weight, moments, sums.moments, sums.total);
    const V depth_difference = hn::Abs(guide.w - c.view_z) / (set(nearby_depth) * c.view_z);
    const V loose =
        hn::Exp(d_, hn::Max(hn::Neg(depth_difference), set(-80.0f))) * hn::Max(cosine, zero);
    add(hn::IfThenElseZero(valid, loose), moments, sums.loose_moments, sums.loose_total);
  }

  static HWY_INLINE void add(V weight, const Quad<V>& moments, Quad<V>& sum, V& total) {
    sum.x = hn::MulAdd(weight, moments.x, sum.x);
    sum.y = hn::MulAdd(weight, moments.y, sum.y);
    sum.z = hn::MulAdd(weight, moments.z, sum.z);
    sum.w = hn::MulAdd(weight, moments.w, sum.w);
    total = total + weight;
  }

  const D d_{};
  const SignalJob& job_;
  bool visibility_;
  bool orthographic_;
  Bounds<D> bounds_;
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
