// The guide image in host kernels: shaders/lib/denoise/guide.glsl in vectors. Included once per
// instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_GUIDE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_GUIDE_HPP
#undef HELIOGRAPH_KERNELS_GUIDE_HPP
#else
#define HELIOGRAPH_KERNELS_GUIDE_HPP
#endif

#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <class V>
struct Guide {
  Triple<V> normal;  // unit length, world space
  V roughness;
  V view_z;  // metres along -Z
};

template <class V>
HWY_INLINE Quad<V> encode_guide(const Guide<V>& guide) {
  const Triple<V> scaled = guide.normal * (hn::Set(hn::DFromV<V>(), 1.0f) + guide.roughness);
  return {scaled.x, scaled.y, scaled.z, guide.view_z};
}

/// Lanes with a surface.
template <class V>
HWY_INLINE auto guide_is_surface(const Quad<V>& texel) {
  return hn::Gt(texel.w, hn::Zero(hn::DFromV<V>()));
}

/// The normal times 1 + roughness.
template <class V>
HWY_INLINE Triple<V> scaled_normal(const Quad<V>& texel) {
  return {texel.x, texel.y, texel.z};
}

/// Also of the background, where the normal is zero.
template <class V>
HWY_INLINE Guide<V> decode_guide(const Quad<V>& texel) {
  const hn::DFromV<V> d;
  const V size = hn::Max(length(scaled_normal(texel)), hn::Set(d, 1e-6f));
  return {scaled_normal(texel) * (hn::Set(d, 1.0f) / size), size - hn::Set(d, 1.0f), texel.w};
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
