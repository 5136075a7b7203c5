// Running means in host kernels: shaders/lib/denoise/moments.glsl and the taps of the frame before
// in vectors. Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_MOMENTS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_MOMENTS_HPP
#undef HELIOGRAPH_KERNELS_MOMENTS_HPP
#else
#define HELIOGRAPH_KERNELS_MOMENTS_HPP
#endif

#include "render/kernels/simd/history.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

inline constexpr float fast_frames = 6.0f;  // of the short history

/// Weight of a new sample in a mean over a history of `frames`, itself included.
template <class V>
HWY_INLINE V sample_weight(V frames, float longest) {
  return hn::Set(hn::DFromV<V>(), 1.0f) / clamped(frames, 1.0f, longest);
}

/// Variance of one sample from its first two moments over `frames` samples, without bias.
template <class V>
HWY_INLINE V sample_variance(V first, V second, V frames) {
  const hn::DFromV<V> d;
  const V known = hn::Max(frames, hn::Set(d, 2.0f));
  const V spread = hn::Max(hn::NegMulAdd(first, first, second), hn::Zero(d));
  return spread * known / (known - hn::Set(d, 1.0f));
}

/// The pixels of the frame before that the pass reproject gives for those from `x` on.
template <class D>
HWY_INLINE HistoryTaps<D> history_taps(const Quad<hn::Vec<D>>& map) {
  const D d;
  const hn::RebindToSigned<D> di;
  HistoryTaps<D> taps(map.x, map.y);
  const auto bits = hn::ConvertTo(di, map.z);
  for (int i = 0; i < 4; ++i) {
    const auto bit = hn::Set(di, 1 << i);
    const auto valid = hn::RebindMask(d, hn::Eq(hn::And(bits, bit), bit));
    taps.keep(i, valid);
  }
  taps.normalise();
  return taps;
}

/// Adds a tap's value times its weight; where the weight is not valid the value may be anything.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void add_weighted(hn::Mask<D> valid, V weight, V value, V& sum) {
  sum = sum + hn::IfThenElseZero(valid, weight * value);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
