// Making rays in host kernels: shaders/lib/math/geometry.glsl and ray_stream.glsl in vectors.
// Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_RAYS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_RAYS_HPP
#undef HELIOGRAPH_KERNELS_RAYS_HPP
#else
#define HELIOGRAPH_KERNELS_RAYS_HPP
#endif

#include <numbers>

#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Two unit vectors that complete `n` to a right-handed frame.
template <class V>
HWY_INLINE void orthonormal_basis(const Triple<V>& n, Triple<V>& tangent, Triple<V>& bitangent) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  const V s = hn::IfThenElse(hn::Ge(n.z, hn::Zero(d)), one, hn::Set(d, -1.0f));
  const V a = hn::Neg(one / (s + n.z));
  const V b = n.x * n.y * a;
  tangent = {hn::MulAdd(s * n.x * n.x, a, one), s * b, hn::Neg(s * n.x)};
  bitangent = {b, hn::MulAdd(n.y * n.y, a, s), hn::Neg(n.y)};
}

/// A point of the unit disk.
template <class V>
HWY_INLINE Pair<V> sample_disk(V u, V v) {
  const hn::DFromV<V> d;
  const V radius = hn::Sqrt(u);
  const V angle = v * hn::Set(d, 2.0f * std::numbers::pi_v<float>);
  return {radius * hn::Cos(d, angle), radius * hn::Sin(d, angle)};
}

/// A direction about `normal` with the density cosine / pi.
template <class V>
HWY_INLINE Triple<V> sample_cosine(const Triple<V>& normal, V u, V v) {
  const hn::DFromV<V> d;
  Triple<V> tangent, bitangent;
  orthonormal_basis(normal, tangent, bitangent);
  const Pair<V> disk = sample_disk(u, v);
  const V up = hn::Sqrt(hn::Max(hn::Set(d, 1.0f) - u, hn::Zero(d)));
  return normalized(tangent * disk.x + bitangent * disk.y + normal * up);
}

/// Its density under `cosine`, per steradian.
template <class V>
HWY_INLINE V cosine_density(V cosine) {
  return cosine * hn::Set(hn::DFromV<V>(), std::numbers::inv_pi_v<float>);
}

template <class V>
HWY_INLINE Triple<V> offset_origin(const Triple<V>& position, const Triple<V>& normal, V distance) {
  const hn::DFromV<V> d;
  const V largest = hn::Max(hn::Abs(position.x), hn::Max(hn::Abs(position.y), hn::Abs(position.z)));
  return position +
         normal * hn::Max(distance * hn::Set(d, 0x1p-15f), largest * hn::Set(d, 0x1p-20f));
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
