#include "render/kernels/post/present.hpp"

#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/post/present.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/tone_map.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class D>
class Presentation {
  using V = hn::Vec<D>;
  using DU = hn::RebindToUnsigned<D>;
  using DI = hn::RebindToSigned<D>;

 public:
  HWY_INLINE explicit Presentation(const PresentJob& job)
      : job_(job),
        width_(static_cast<int>(job.constants.shown.x)),
        curve_(static_cast<int>(job.frame.tone_map_curve)),
        dither_(DU(), 0u, 5u, 0u) {}

  HWY_INLINE void rows(int first, int last) const {
    const int lanes = static_cast<int>(hn::Lanes(d_));
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < width_; x += lanes) block(std::min(x, width_ - lanes), y);
    }
  }

 private:
  HWY_INLINE V set(float value) const { return hn::Set(d_, value); }
  HWY_INLINE Triple<V> load(const gpu::HostView& image, int x, int y) const {
    const Quad<V> t = load4(d_, row_of<const float>(image, y) + 4 * x);
    return {t.x, t.y, t.z};
  }

  HWY_INLINE Triple<V> mean_at(int x, int y) const {
    return load_half3(d_, row_of<const std::uint32_t>(job_.mean, y) + 2 * x);
  }

  /// Of the nearest pixels that were drawn.
  HWY_INLINE Triple<V> nearest(int x, int y) const {
    const glm::uvec2 shown = job_.constants.shown, drawn = job_.constants.drawn;
    if (shown == drawn) return load(job_.radiance, x, y);
    const DU du;
    const auto twice = hn::ShiftLeft<1>(hn::Iota(du, static_cast<std::uint32_t>(x)));
    const V across = hn::ConvertTo(d_, hn::Add(twice, hn::Set(du, 1u)));
    // Quotients are multiples of half a step: a quarter more keeps rounding on the right side.
    const float step = 1.0f / static_cast<float>(shown.x);
    const V column =
        hn::MulAdd(across, set(0.5f * step * static_cast<float>(drawn.x)), set(0.25f * step));
    const hn::RebindToSigned<D> di;
    const auto row =
        static_cast<int>((2u * static_cast<unsigned>(y) + 1u) * drawn.y / (2 * shown.y));
    return gather3(d_, row_of<const float>(job_.radiance, row),
                   hn::ShiftLeft<2>(hn::ConvertTo(di, column)));
  }

  HWY_INLINE Triple<V> radiance(int x, int y) const {
    const float uniform = job_.constants.weight;
    if (uniform >= 1.0f) return mean_at(x, y);
    if (uniform == 0.0f) return nearest(x, y);
    const V weight =
        uniform > 0.0f ? set(uniform) : hn::LoadU(d_, row_of<const float>(job_.mean_weight, y) + x);
    const auto none = hn::Le(weight, hn::Zero(d_)), all = hn::Ge(weight, set(1.0f));
    if (hn::AllTrue(d_, all)) return mean_at(x, y);
    const Triple<V> frame = nearest(x, y);
    if (hn::AllTrue(d_, none)) return frame;
    // What has no weight may be no number.
    const Triple<V> mean = mean_at(x, y);
    return select(all, mean, select(none, frame, mix(frame, mean, weight)));
  }

  HWY_INLINE Triple<V> tone_map(const Triple<V>& color) const {
    switch (curve_) {
      case 0:
        return tone_map_neutral(color);
      case 1:
        return tone_map_aces(color);
      case 2:
        return tone_map_agx(color);
      default:
        return clamped(color, 0.0f, 1.0f);
    }
  }

  HWY_INLINE auto code_value(V linear, V noise) const {
    const V encoded = clamped(srgb_encode(linear) + noise, 0.0f, 1.0f);
    return hn::BitCast(DU(), hn::NearestInt(encoded * set(255.0f)));
  }

  HWY_INLINE void block(int x, int y) const {
    const V zero = hn::Zero(d_), factor = set(job_.exposure->factor);
    const Triple<V> color = radiance(x, y);
    const Triple<V> shown =
        tone_map({hn::Max(color.x, zero) * factor, hn::Max(color.y, zero) * factor,
                  hn::Max(color.z, zero) * factor});
    // The same noise in every frame, so that a converged frame does not change.
    V a, b;
    const DU du;
    dither_.at(hn::Iota(du, static_cast<std::uint32_t>(x)), static_cast<std::uint32_t>(y), a, b);
    const V noise = (a - b) * set(0.5f / 255.0f);
    const auto red = code_value(shown.x, noise), green = code_value(shown.y, noise);
    const auto blue = code_value(shown.z, noise);
    const auto opaque = hn::Set(du, 0xff000000u);
    const auto packed =
        hn::Or(hn::Or(red, hn::ShiftLeft<8>(green)), hn::Or(hn::ShiftLeft<16>(blue), opaque));
    hn::StoreU(packed, du, row_of<std::uint32_t>(job_.output, y) + x);
  }

  const D d_{};
  const PresentJob& job_;
  int width_;
  int curve_;
  RandomPairs<DU> dither_;
};

void present_rows(const PresentJob& job, int first, int last) {
  run_rows<Presentation>(job, static_cast<int>(job.constants.shown.x), first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(present_rows);

void present(const PresentJob& job) {
  for_each_band(static_cast<int>(job.constants.shown.y), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(present_rows)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
