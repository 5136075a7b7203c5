#include "render/kernels/atrous.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/atrous.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/guide.hpp"
#include "render/kernels/simd/random.hpp"

#ifndef HELIOGRAPH_ATROUS_JOB
#define HELIOGRAPH_ATROUS_JOB
namespace heliograph::render::kernels {

/// What a signal's four floats are: shaders/lib/denoise/visibility_signal.glsl and
/// specular_signal.glsl.
enum class Signal { visibility, specular };

struct Job : AtrousJob {
  Signal kind;
  float footprint;  // of a pixel at one metre, or at any in an orthographic view
  bool orthographic;
};

}  // namespace heliograph::render::kernels
#endif

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One row of one iteration; lanes are pixels side by side.
template <class D, Signal kind>
class Row {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;
  using M = hn::Mask<D>;
  static constexpr bool visibility = kind == Signal::visibility;

  using Texels = Quad<V>;
  struct Center {
    Triple<V> normal;
    V roughness;
    V view_z;
    V slope_x, slope_y;
    V curve;      // 1 / Z, 0 in orthographic views
    V flattened;  // 1 - Z * curve
    V footprint;  // half of a pixel's
    V bright_x, bright_y;
    V inv_sigma_x, inv_sigma_y;  // 1 / what a difference of brightness may be
    V roughness_reach;
  };
  struct Sums {
    Texels value;
    V total_x, total_y;
  };

 public:
  HWY_INLINE Row(const Job& job, int y, float* variance)
      : job_(job),
        c_(job.constants),
        y_(y),
        pitch_(static_cast<int>(job.guide.row_pitch / sizeof(float))),
        signal_pitch_(static_cast<int>(job.signal.row_pitch / sizeof(float))),
        random_(hn::RebindToUnsigned<D>(), job.frame.sample_index,
                48u + static_cast<unsigned>(c_.level), job.frame.seed),
        variance_x_(variance),
        variance_y_(variance + job.width + 2) {}

  HWY_INLINE void run() {
    if (has(shared::atrous_variance_prefilter)) add_variance_rows();
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int x = 0; x < job_.width; x += lanes) block(std::min(x, job_.width - lanes));
  }

 private:
  bool has(std::uint32_t flag) const { return (c_.flags & flag) != 0; }
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }

  HWY_INLINE Texels load(const float* from) const { return load4(d_, from); }
  const float* row(const gpu::HostView& image, int y) const {
    return row_of<const float>(image, y);
  }

  HWY_INLINE V brightness_x(const Texels& t) const {
    if constexpr (visibility) return t.x;
    return luminance(Triple<V>{t.x, t.y, t.z});
  }

  /// Sums down of the variance, weights 1 2 1, into the scratch rows; one pixel more on both ends.
  HWY_INLINE void add_variance_rows() {
    const float* above = row(job_.signal, std::max(y_ - 1, 0));
    const float* here = row(job_.signal, y_);
    const float* below = row(job_.signal, std::min(y_ + 1, job_.height - 1));
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int i = 0; i < job_.width; i += lanes) {
      const int x = std::min(i, job_.width - lanes);
      const Texels a = load(above + 4 * x), b = load(here + 4 * x), c = load(below + 4 * x);
      if constexpr (visibility) {
        hn::StoreU(hn::Add(hn::Add(a.z, c.z), hn::Add(b.z, b.z)), d_, variance_x_ + x + 1);
        hn::StoreU(hn::Add(hn::Add(a.w, c.w), hn::Add(b.w, b.w)), d_, variance_y_ + x + 1);
      } else {
        hn::StoreU(hn::Add(hn::Add(a.w, c.w), hn::Add(b.w, b.w)), d_, variance_x_ + x + 1);
      }
    }
    for (float* sums : {variance_x_, variance_y_}) {
      sums[0] = sums[1];
      sums[job_.width + 1] = sums[job_.width];
    }
  }

  HWY_INLINE V smooth_variance(const float* sums, int x) const {
    const V left = hn::LoadU(d_, sums + x), middle = hn::LoadU(d_, sums + x + 1);
    const V right = hn::LoadU(d_, sums + x + 2);
    return hn::Mul(hn::Add(hn::Add(left, right), hn::Add(middle, middle)), set(1.0f / 16.0f));
  }

  /// 1 / (sigma x standard deviation + smallest difference)
  HWY_INLINE V inv_sigma(V variance) const {
    const V noise = hn::Sqrt(hn::Max(variance, hn::Zero(d_)));
    const float smallest = visibility ? 1e-3f : 1e-4f;
    return hn::Div(set(1.0f), hn::MulAdd(set(c_.luminance_sigma), noise, set(smallest)));
  }

  HWY_INLINE Center center(int x, const Guide<V>& guide, const Texels& value) const {
    Center c;
    c.normal = guide.normal;
    c.roughness = guide.roughness;
    c.view_z = guide.view_z;
    hn::LoadInterleaved2(d_, row(job_.depth_slope, y_) + 2 * x, c.slope_x, c.slope_y);
    c.curve = job_.orthographic ? hn::Zero(d_) : hn::Div(set(1.0f), guide.view_z);
    c.flattened = hn::Sub(set(1.0f), hn::Mul(c.view_z, c.curve));
    c.footprint = set(0.5f * job_.footprint);
    if (!job_.orthographic) c.footprint = hn::Mul(c.footprint, guide.view_z);
    c.bright_x = brightness_x(value);
    c.bright_y = value.y;
    const bool smooth = has(shared::atrous_variance_prefilter);
    if constexpr (visibility) {
      c.inv_sigma_x = inv_sigma(smooth ? smooth_variance(variance_x_, x) : value.z);
      c.inv_sigma_y = inv_sigma(smooth ? smooth_variance(variance_y_, x) : value.w);
    } else {
      c.inv_sigma_x = inv_sigma(smooth ? smooth_variance(variance_x_, x) : value.w);
      c.roughness_reach = hn::Div(set(1.0f), hn::MulAdd(set(0.2f), c.roughness, set(0.02f)));
    }
    return c;
  }

  HWY_INLINE void add_tap(const Center& c, const Texels& guide, const Texels& value, V offset_x,
                          V offset_y, V distance, float weight, M requested, Sums& sums) const {
    const V rise = hn::MulAdd(c.slope_x, offset_x, hn::Mul(c.slope_y, offset_y));
    const V straight = hn::NegMulAdd(rise, c.curve, set(1.0f));
    const V off_plane =
        hn::Abs(hn::NegMulAdd(rise, c.flattened, hn::Sub(hn::Mul(guide.w, straight), c.view_z)));
    const V allowed = hn::MulAdd(c.footprint, distance, hn::Abs(rise));
    V exponent =
        hn::Div(hn::Neg(off_plane), hn::Max(hn::Mul(set(c_.depth_sigma), allowed), set(1e-30f)));
    const V cosine = clamped(guide_cosine(c.normal, guide), 1e-6f, 1.0f);
    exponent = hn::MulAdd(set(c_.normal_power), hn::Log(d_, cosine), exponent);
    const M valid = hn::And(requested, guide_is_surface(guide));
    if constexpr (visibility) {
      const V wx = tap_weight(exponent, c.bright_x, value.x, c.inv_sigma_x, weight, valid);
      const V wy = tap_weight(exponent, c.bright_y, value.y, c.inv_sigma_y, weight, valid);
      sums.value.x = hn::MulAdd(wx, value.x, sums.value.x);
      sums.value.y = hn::MulAdd(wy, value.y, sums.value.y);
      sums.value.z = hn::MulAdd(hn::Mul(wx, wx), value.z, sums.value.z);
      sums.value.w = hn::MulAdd(hn::Mul(wy, wy), value.w, sums.value.w);
      sums.total_x = hn::Add(sums.total_x, wx);
      sums.total_y = hn::Add(sums.total_y, wy);
    } else {
      const V rougher = hn::Abs(hn::Sub(guide_roughness(guide), c.roughness));
      exponent = hn::NegMulAdd(rougher, c.roughness_reach, exponent);
      const V w =
          tap_weight(exponent, c.bright_x, brightness_x(value), c.inv_sigma_x, weight, valid);
      sums.value.x = hn::MulAdd(w, value.x, sums.value.x);
      sums.value.y = hn::MulAdd(w, value.y, sums.value.y);
      sums.value.z = hn::MulAdd(w, value.z, sums.value.z);
      sums.value.w = hn::MulAdd(hn::Mul(w, w), value.w, sums.value.w);
      sums.total_x = hn::Add(sums.total_x, w);
    }
  }

  HWY_INLINE V tap_weight(V exponent, V here, V there, V inv_sigma, float weight, M valid) const {
    const V e = hn::NegMulAdd(hn::Abs(hn::Sub(here, there)), inv_sigma, exponent);
    // Below e^-80 a weight is nothing; the exponential stays in its range.
    const V positive = hn::Mul(hn::Exp(d_, hn::Max(e, set(-80.0f))), set(weight));
    return hn::IfThenElseZero(valid, positive);
  }

  HWY_INLINE V levels(V roughness) const {
    V most = set(16.0f);
    if (has(shared::atrous_lobe_limit) && !job_.orthographic) {
      const V pixels = hn::Mul(hn::Mul(roughness, roughness), set(2.0f / job_.footprint));
      // The whole part of the logarithm is the exponent; below 1 it is negative.
      const V power = hn::ConvertTo(
          d_, hn::Sub(hn::ShiftRight<23>(hn::BitCast(di_, hn::Max(pixels, set(0.5f)))),
                      hn::Set(di_, 127)));
      most = hn::Add(power, set(1.0f));
    }
    if (!has(shared::atrous_levels_by_roughness)) return most;
    const V rough = hn::IfThenElse(hn::Le(roughness, set(shared::atrous_blurred_once_roughness)),
                                   set(1.0f), set(16.0f));
    const M unblurred = hn::Le(roughness, set(shared::atrous_unblurred_roughness));
    return hn::Min(most, hn::IfThenElse(unblurred, hn::Zero(d_), rough));
  }

  /// Pixels from tap to tap.
  HWY_INLINE V steps(V roughness) const {
    const float low = c_.start_threshold - shared::atrous_step_half_band;
    const float high = c_.start_threshold + shared::atrous_step_half_band;
    const V t = hn::Min(
        hn::Max(hn::Mul(hn::Sub(roughness, set(low)), set(1.0f / (high - low))), hn::Zero(d_)),
        set(1.0f));
    const V twice = hn::Mul(hn::Mul(t, t), hn::NegMulAdd(set(2.0f), t, set(3.0f)));
    return hn::Round(hn::Mul(set(static_cast<float>(1 << c_.level)), hn::Add(set(1.0f), twice)));
  }

  HWY_INLINE void block(int x) {
    const Texels value = load(row(job_.signal, y_) + 4 * x);
    const Texels texel = load(row(job_.guide, y_) + 4 * x);
    const Guide<V> guide = decode_guide(texel);
    const M active = hn::And(guide_is_surface(texel),
                             hn::Lt(set(static_cast<float>(c_.level)), levels(guide.roughness)));
    float* out = const_cast<float*>(row(job_.filtered, y_)) + 4 * x;
    if (hn::AllFalse(d_, active)) {
      hn::StoreInterleaved4(value.x, value.y, value.z, value.w, d_, out);
      return;
    }
    const Center c = center(x, guide, value);
    Sums sums{value, set(1.0f), set(1.0f)};
    add_taps(x, active, steps(guide.roughness), c, sums);

    const V by_x = hn::Div(set(1.0f), sums.total_x);
    const V by_y = visibility ? hn::Div(set(1.0f), sums.total_y) : by_x;
    Texels result{hn::Mul(sums.value.x, by_x), hn::Mul(sums.value.y, by_y),
                  hn::Mul(sums.value.z, by_x), hn::Mul(sums.value.w, hn::Mul(by_y, by_y))};
    if constexpr (visibility) result.z = hn::Mul(result.z, by_x);
    if (has(shared::atrous_keep_variance)) {
      if constexpr (visibility) result.z = value.z;
      result.w = value.w;
    }
    hn::StoreInterleaved4(hn::IfThenElse(active, result.x, value.x),
                          hn::IfThenElse(active, result.y, value.y),
                          hn::IfThenElse(active, result.z, value.z),
                          hn::IfThenElse(active, result.w, value.w), d_, out);
  }

  /// Where all lanes take the same steps inside the frame, texels are contiguous.
  HWY_INLINE void add_taps(int x, M active, V step, const Center& c, Sums& sums) {
    const float least = hn::GetLane(hn::MinOfLanes(d_, hn::IfThenElse(active, step, set(1e9f))));
    const float most = hn::GetLane(hn::MaxOfLanes(d_, hn::IfThenElseZero(active, step)));
    const int radius = c_.columns * static_cast<int>(most);
    const bool inside = x >= radius && x + static_cast<int>(hn::Lanes(d_)) + radius <= job_.width;
    const bool jittered = has(shared::atrous_jitter) && most > 4.0f;
    if (least == most && inside && !jittered) {
      add_straight_taps(x, static_cast<int>(most), active, c, sums);
    } else {
      add_scattered_taps(x, step, active, c, sums);
    }
  }

  HWY_INLINE void add_straight_taps(int x, int step, M active, const Center& c, Sums& sums) const {
    for (int j = -c_.rows; j <= c_.rows; ++j) {
      const int y = y_ + j * step;
      if (y < 0 || y >= job_.height) continue;
      for (int i = -c_.columns; i <= c_.columns; ++i) {
        if (i == 0 && j == 0) continue;
        const int at = 4 * (x + i * step);
        const auto dx = static_cast<float>(i * step), dy = static_cast<float>(j * step);
        add_tap(c, load(row(job_.guide, y) + at), load(row(job_.signal, y) + at), set(dx), set(dy),
                set(std::sqrt(dx * dx + dy * dy)), kernel(i) * kernel(j), active, sums);
      }
    }
  }

  HWY_INLINE void add_scattered_taps(int x, V step, M active, const Center& c, Sums& sums) const {
    const VI column = hn::Iota(di_, x);
    V shift_x = hn::Zero(d_), shift_y = hn::Zero(d_);
    if (has(shared::atrous_jitter)) {
      const hn::RebindToUnsigned<D> du;
      random_.at(hn::BitCast(du, column), static_cast<std::uint32_t>(y_), shift_x, shift_y);
      const M large = hn::Gt(step, set(4.0f));
      const V span = hn::IfThenElseZero(large, hn::Mul(set(0.5f), step));
      shift_x = hn::Round(hn::Mul(hn::Sub(shift_x, set(0.5f)), span));
      shift_y = hn::Round(hn::Mul(hn::Sub(shift_y, set(0.5f)), span));
    }
    for (int j = -c_.rows; j <= c_.rows; ++j) {
      for (int i = -c_.columns; i <= c_.columns; ++i) {
        if (i == 0 && j == 0) continue;
        const V dx = hn::MulAdd(set(static_cast<float>(i)), step, shift_x);
        const V dy = hn::MulAdd(set(static_cast<float>(j)), step, shift_y);
        add_scattered_tap(column, dx, dy, kernel(i) * kernel(j), active, c, sums);
      }
    }
  }

  HWY_INLINE void add_scattered_tap(VI column, V dx, V dy, float weight, M active, const Center& c,
                                    Sums& sums) const {
    const VI zero = hn::Zero(di_);
    const VI x = hn::Add(column, hn::ConvertTo(di_, dx));
    const VI y = hn::Add(hn::Set(di_, y_), hn::ConvertTo(di_, dy));
    const VI inside_x = hn::Min(hn::Max(x, zero), hn::Set(di_, job_.width - 1));
    const VI inside_y = hn::Min(hn::Max(y, zero), hn::Set(di_, job_.height - 1));
    const M inside = hn::RebindMask(d_, hn::And(hn::Eq(x, inside_x), hn::Eq(y, inside_y)));
    const M requested = hn::And(active, inside);
    if (hn::AllFalse(d_, requested)) return;
    const VI texel = hn::ShiftLeft<2>(inside_x);
    const VI in_guide = hn::Add(hn::Mul(inside_y, hn::Set(di_, pitch_)), texel);
    const VI in_signal = hn::Add(hn::Mul(inside_y, hn::Set(di_, signal_pitch_)), texel);
    add_tap(c, gather4(d_, row(job_.guide, 0), in_guide),
            gather4(d_, row(job_.signal, 0), in_signal), dx, dy,
            hn::Sqrt(hn::MulAdd(dx, dx, hn::Mul(dy, dy))), weight, requested, sums);
  }

  /// Of the B3 spline (1, 4, 6, 4, 1) / 16, against its middle.
  static float kernel(int i) {
    const int distance = std::abs(i);
    return distance == 0 ? 1.0f : distance == 1 ? 2.0f / 3.0f : 1.0f / 6.0f;
  }

  const D d_{};
  const DI di_{};
  const Job& job_;
  const shared::AtrousConstants& c_;
  int y_;
  int pitch_;
  int signal_pitch_;
  RandomPairs<hn::RebindToUnsigned<D>> random_;
  float* variance_x_;
  float* variance_y_;
};

template <class D>
void filter_rows_of(const Job& job, int first, int last) {
  std::vector<float> scratch(2 * static_cast<std::size_t>(job.width + 2));
  for (int y = first; y < last; ++y) {
    if (job.kind == Signal::visibility) {
      Row<D, Signal::visibility>(job, y, scratch.data()).run();
    } else {
      Row<D, Signal::specular>(job, y, scratch.data()).run();
    }
  }
}

void filter_rows(const Job& job, int first, int last) {
  using Wide = hn::ScalableTag<float>;
  if (static_cast<std::size_t>(job.width) >= hn::Lanes(Wide())) {
    filter_rows_of<Wide>(job, first, last);
  } else {
    filter_rows_of<hn::FixedTag<float, 1>>(job, first, last);
  }
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(filter_rows);

namespace {

void filter(const AtrousJob& pass, Signal kind) {
  const shared::FrameConstants& frame = pass.frame;
  const bool orthographic = (frame.flags & shared::frame_orthographic) != 0;
  const float footprint = 2.0f * std::abs(frame.unproject.y) / static_cast<float>(frame.extent.y);
  const Job job{pass, kind, footprint, orthographic};
  for_each_band(job.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(filter_rows)(job, first, last);
  });
}

}  // namespace

void visibility_atrous(const AtrousJob& job) {
  filter(job, Signal::visibility);
}

void specular_atrous(const AtrousJob& job) {
  filter(job, Signal::specular);
}

}  // namespace heliograph::render::kernels
#endif
