// The a-trous filter of a row of pixels, as shaders/lib/denoise/atrous.glsl has it: one pass of an
// iteration over rows in planes. Included once per instruction set; the guard is Google Highway's
// convention.
#if defined(HELIOGRAPH_KERNELS_ATROUS_FILTER_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_ATROUS_FILTER_HPP
#undef HELIOGRAPH_KERNELS_ATROUS_FILTER_HPP
#else
#define HELIOGRAPH_KERNELS_ATROUS_FILTER_HPP
#endif

#include "render/kernels/simd/denoise/atrous_taps.hpp"
#include "render/kernels/simd/edge_stopping.hpp"
#include "render/kernels/simd/signal_rows.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Pixels from tap to tap, at least and at most.
struct AtrousSteps {
  int least, most;
  /// Of the taps, jitter included, in pixels.
  int reach() const { return 2 * most + most / 4 + 1; }
};

/// Pixels from tap to tap on a surface: step_at() of the shaders.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V atrous_step(D d, const shared::AtrousConstants& c, V rough) {
  const float low = c.start_threshold - shared::atrous_step_half_band;
  const float high = c.start_threshold + shared::atrous_step_half_band;
  const V t = clamped((rough - hn::Set(d, low)) * hn::Set(d, 1.0f / (high - low)), 0.0f, 1.0f);
  const V twice = t * t * hn::NegMulAdd(hn::Set(d, 2.0f), t, hn::Set(d, 3.0f));
  return hn::Round(hn::Set(d, static_cast<float>(1 << c.level)) * (hn::Set(d, 1.0f) + twice));
}

/// Those of all surfaces.
inline AtrousSteps atrous_steps(const shared::AtrousConstants& constants) {
  const hn::FixedTag<float, 1> d;
  const auto at = [&](float rough) HWY_ATTR {
    return static_cast<int>(hn::GetLane(atrous_step(d, constants, hn::Set(d, rough))));
  };
  return {at(0.0f), at(1.0f)};
}

/// One pass over a frame.
struct AtrousPass {
  const shared::AtrousConstants& constants;
  const shared::FrameConstants& frame;
  gpu::HostView depth_slope;
  int height;
  float footprint;  // of a pixel at one metre, or at any in an orthographic view
  bool orthographic;
  AtrousSteps steps;
};

/// Lanes are pixels side by side. `straight`: all taps lie on one axis. `channels`: the first plane
/// of the signal that is filtered.
template <class D, bool visibility, bool straight, int channels>
class AtrousFilter {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using M = hn::Mask<D>;
  using Rows = SignalRows<D, visibility>;

  /// Of the plane through a pixel: what a neighbour's Z is multiplied with, and what is expected of
  /// the product. Their difference is the exponent.
  struct Expected {
    V scale;
    V product;
  };
  /// All exponents count octaves.
  struct Center {
    Triple<V> normal;  // times the power
    V roughness;
    V roughness_reach;
    V view_z;
    Pair<V> slope;
    V curve;                                 // 1 / Z, 0 in orthographic views
    V flattened;                             // 1 - Z * curve
    V footprint;                             // half of a pixel's
    V inv_allowed;                           // 1 / what the plane may be missed by, per pixel
    V curve_scale, depth_scale, flat_scale;  // that times slope * curve, Z, slope * flattened
    V bright[2];
    V inv_sigma[2];  // 1 / what a difference of brightness may be
  };
  struct Sums {
    Quad<V> value;
    V total[2];
  };

 public:
  /// `rows` and what `pass` refers to outlive this. `footprint`: of a pixel at one metre, or at any
  /// distance in an orthographic view.
  HWY_INLINE AtrousFilter(const AtrousPass& pass, const Rows& rows)
      : pass_(pass),
        c_(pass.constants),
        rows_(rows),
        least_step_(pass.steps.least),
        most_step_(pass.steps.most),
        taps_(c_, pass.frame, pass.height, least_step_, most_step_) {}

  /// Prepares row `y`, pixels `left` to `right`.
  HWY_INLINE void begin_row(int left, int right, int y) {
    if (has(shared::atrous_variance_prefilter)) {
      rows_.add_variance_rows(channels, left, right, y);
    }
  }

  /// The pixels from `x` on, of the row that began last.
  HWY_INLINE Quad<V> filtered(int x, int y) {
    const int column = x - rows_.area().left;
    const float* const texels = rows_.row(y) + column;
    const V rough = load(texels, Rows::roughness);
    const Quad<V> value{load(texels, channels), load(texels, channels + 1),
                        load(texels, channels + 2), load(texels, channels + 3)};
    const M active = hn::And(hn::Gt(load(texels, Rows::view_z), hn::Zero(d_)),
                             hn::Lt(set(static_cast<float>(c_.level)), levels(rough)));
    if (hn::AllFalse(d_, active)) return value;
    const Center c = center(texels, x, y);
    Sums sums{value, {set(1.0f), set(1.0f)}};
    if (least_step_ == most_step_) {
      add_taps(c, most_step_, column, y, active, sums);
    } else {
      add_taps_of_steps(c, hn::Min(steps(rough), set(static_cast<float>(most_step_))), column, y,
                        active, sums);
    }
    return select(active, result(sums, value), value);
  }

 private:
  bool has(std::uint32_t flag) const { return (c_.flags & flag) != 0; }
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  HWY_INLINE V load(const float* texels, int plane) const { return rows_.load(texels, plane); }

  HWY_INLINE V variance_at(const float* texels, int column, int i) const {
    if (has(shared::atrous_variance_prefilter)) return rows_.smooth_variance(column, i);
    return load(texels, channels + Rows::variance + i);
  }

  /// 1 / (sigma x standard deviation + smallest difference), in octaves.
  HWY_INLINE V inv_sigma(V of) const {
    const V safe = hn::Max(of, set(1e-30f));
    const V noise = safe * hn::ApproximateReciprocalSqrt(safe);
    const float smallest = visibility ? 1e-3f : 1e-4f;
    const V allowed = hn::MulAdd(set(c_.luminance_sigma / octaves), noise, set(smallest / octaves));
    return hn::ApproximateReciprocal(allowed);
  }

  HWY_INLINE Center center(const float* texels, int x, int y) const {
    Center c;
    const V power = set(c_.normal_power * octaves);
    c.normal = Triple<V>{load(texels, Rows::normal_x), load(texels, Rows::normal_y),
                         load(texels, Rows::normal_z)} *
               power;
    c.roughness = load(texels, Rows::roughness);
    c.view_z = load(texels, Rows::view_z);
    c.slope = load2(d_, row_of<const float>(pass_.depth_slope, y) + 2 * x);
    c.curve = pass_.orthographic ? hn::Zero(d_) : reciprocal(c.view_z);
    c.flattened = pass_.orthographic ? set(1.0f) : hn::Zero(d_);
    c.footprint = set(0.5f * pass_.footprint);
    if (!pass_.orthographic) c.footprint = c.footprint * c.view_z;
    if constexpr (straight) {
      const V slope = c_.columns > 0 ? c.slope.x : c.slope.y;
      const float sigma = c_.depth_sigma / octaves;
      c.inv_allowed = hn::ApproximateReciprocal(
          hn::Max(set(sigma) * (hn::Abs(slope) + c.footprint), set(1e-30f)));
      c.depth_scale = c.view_z * c.inv_allowed;
      const V steepness = slope * c.inv_allowed;
      c.curve_scale = steepness * c.curve;
      c.flat_scale = steepness * c.flattened;
    }
    if constexpr (visibility) {
      c.bright[0] = load(texels, channels);
      c.bright[1] = load(texels, channels + 1);
    } else {
      c.bright[0] = load(texels, channels + 4);
      c.roughness_reach = hn::ApproximateReciprocal(
          hn::MulAdd(set(0.2f / octaves), c.roughness, set(0.02f / octaves)));
    }
    for (int i = 0; i < Rows::variances; ++i) {
      c.inv_sigma[i] = inv_sigma(variance_at(texels, x - rows_.area().left, i));
    }
    return c;
  }

  /// plane_distance() / depth_allowance() of the shaders, taken apart.
  HWY_INLINE Expected expected(const Center& c, const AtrousTap& tap) const {
    if constexpr (straight) {
      const V inv_distance = set(tap.inv_distance), side = set(tap.side);
      const V scale = hn::NegMulAdd(side, c.curve_scale, c.inv_allowed * inv_distance);
      const V product = c.depth_scale * inv_distance;
      return {scale, pass_.orthographic ? hn::MulAdd(side, c.flat_scale, product) : product};
    } else {
      const V rise = hn::MulAdd(c.slope.x, set(tap.dx), c.slope.y * set(tap.dy));
      const V allowed = hn::MulAdd(c.footprint, set(1.0f / tap.inv_distance), hn::Abs(rise));
      const V inv_allowed =
          hn::ApproximateReciprocal(hn::Max(set(c_.depth_sigma / octaves) * allowed, set(1e-30f)));
      return {inv_allowed * hn::NegMulAdd(rise, c.curve, set(1.0f)),
              inv_allowed * hn::MulAdd(rise, c.flattened, c.view_z)};
    }
  }

  HWY_INLINE void add_tap(const Center& c, const AtrousTap& tap, int column, M requested,
                          Sums& sums) const {
    const float* const texels = tap.texels + column;
    const V z = load(texels, Rows::view_z);
    const M valid = hn::And(requested, hn::Gt(z, hn::Zero(d_)));
    V exponent = hn::MulAdd(c.normal.x, load(texels, Rows::normal_x),
                            set(tap.exponent + weight_one - c_.normal_power * octaves));
    exponent = hn::MulAdd(c.normal.y, load(texels, Rows::normal_y), exponent);
    exponent = hn::MulAdd(c.normal.z, load(texels, Rows::normal_z), exponent);
    const Expected plane = expected(c, tap);
    exponent = exponent - hn::Abs(hn::MulSub(z, plane.scale, plane.product));
    const V x = load(texels, channels), y = load(texels, channels + 1);
    const V v = load(texels, channels + 2), w = load(texels, channels + 3);
    if constexpr (visibility) {
      const V of_x = weight(valid, exponent, c, x, 0), of_y = weight(valid, exponent, c, y, 1);
      sums.value.x = hn::MulAdd(of_x, x, sums.value.x);
      sums.value.y = hn::MulAdd(of_y, y, sums.value.y);
      sums.value.z = hn::MulAdd(of_x * of_x, v, sums.value.z);
      sums.value.w = hn::MulAdd(of_y * of_y, w, sums.value.w);
      sums.total[0] = sums.total[0] + of_x;
      sums.total[1] = sums.total[1] + of_y;
    } else {
      const V rougher = hn::Abs(load(texels, Rows::roughness) - c.roughness);
      exponent = hn::NegMulAdd(rougher, c.roughness_reach, exponent);
      const V all = weight(valid, exponent, c, load(texels, channels + 4), 0);
      sums.value.x = hn::MulAdd(all, x, sums.value.x);
      sums.value.y = hn::MulAdd(all, y, sums.value.y);
      sums.value.z = hn::MulAdd(all, v, sums.value.z);
      sums.value.w = hn::MulAdd(all * all, w, sums.value.w);
      sums.total[0] = sums.total[0] + all;
    }
  }

  HWY_INLINE V weight(M valid, V exponent, const Center& c, V bright, int i) const {
    const V apart = hn::Abs(bright - c.bright[i]);
    return edge_weight(valid, hn::NegMulAdd(apart, c.inv_sigma[i], exponent));
  }

  HWY_INLINE V levels(V rough) const {
    V most = set(16.0f);
    if (has(shared::atrous_lobe_limit) && !pass_.orthographic) {
      const V pixels = rough * rough * set(2.0f / pass_.footprint);
      // The whole part of the logarithm is the exponent; below 1 it is negative.
      const auto bits = hn::BitCast(DI(), hn::Max(pixels, set(0.5f)));
      most = hn::ConvertTo(d_, hn::ShiftRight<23>(bits)) - set(126.0f);
    }
    if (!has(shared::atrous_levels_by_roughness)) return most;
    const V some = hn::IfThenElse(hn::Le(rough, set(shared::atrous_blurred_once_roughness)),
                                  set(1.0f), set(16.0f));
    const M unblurred = hn::Le(rough, set(shared::atrous_unblurred_roughness));
    return hn::Min(most, hn::IfThenElse(unblurred, hn::Zero(d_), some));
  }

  HWY_INLINE V steps(V rough) const { return atrous_step(d_, c_, rough); }

  HWY_INLINE Quad<V> result(const Sums& sums, const Quad<V>& value) const {
    const V by_x = reciprocal(sums.total[0]);
    const V by_y = visibility ? reciprocal(sums.total[1]) : by_x;
    Quad<V> filtered{sums.value.x * by_x, sums.value.y * by_y, sums.value.z * by_x,
                     sums.value.w * (by_y * by_y)};
    if constexpr (visibility) filtered.z = filtered.z * by_x;
    if (has(shared::atrous_keep_variance)) {
      if constexpr (visibility) filtered.z = value.z;
      filtered.w = value.w;
    }
    return filtered;
  }

  HWY_INLINE void add_taps(const Center& c, int step, int column, int y, M requested, Sums& sums) {
    const auto row = [this](int at) { return rows_.row(at); };
    for (const AtrousTap& tap : taps_.at(step, y, row)) add_tap(c, tap, column, requested, sums);
  }

  /// Pixels of each step by themselves.
  HWY_INLINE void add_taps_of_steps(const Center& c, V step, int column, int y, M active,
                                    Sums& sums) {
    for (M left = active; !hn::AllFalse(d_, left);) {
      const float next = hn::GetLane(hn::MinOfLanes(d_, hn::IfThenElse(left, step, set(1e9f))));
      const M same = hn::And(left, hn::Eq(step, set(next)));
      add_taps(c, static_cast<int>(next), column, y, same, sums);
      left = hn::AndNot(same, left);
    }
  }

  const D d_{};
  const AtrousPass& pass_;
  const shared::AtrousConstants& c_;
  const Rows& rows_;
  int least_step_, most_step_;
  AtrousTapRows taps_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
