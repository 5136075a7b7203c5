// Directions of rays that gather light: shaders/lib/math/geometry.glsl in vectors. Included once
// per instruction set.
#if defined(HELIOGRAPH_KERNELS_GATHERING_RAYS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_GATHERING_RAYS_HPP
#undef HELIOGRAPH_KERNELS_GATHERING_RAYS_HPP
#else
#define HELIOGRAPH_KERNELS_GATHERING_RAYS_HPP
#endif

#include "render/kernels/simd/rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Two unit vectors that complete `n` to a right-handed frame. Normals which follow the same axis
/// most have much the same.
template <class V>
HWY_INLINE void axis_basis(const Triple<V>& n, Triple<V>& tangent, Triple<V>& bitangent) {
  const hn::DFromV<V> d;
  const V x = hn::Abs(n.x), y = hn::Abs(n.y), z = hn::Abs(n.z);
  const auto follows_x = hn::And(hn::Ge(x, y), hn::Ge(x, z));
  const auto follows_y = hn::AndNot(follows_x, hn::Ge(y, z));
  const V one = hn::Set(d, 1.0f);
  const Triple<V> along{hn::IfThenZeroElse(hn::Or(follows_x, follows_y), one),
                        hn::IfThenElseZero(follows_x, one), hn::IfThenElseZero(follows_y, one)};
  tangent = normalized(along - n * dot(along, n));
  bitangent = cross(n, tangent);
}

/// A direction about `normal` with the density cosine / pi, in that frame.
template <class V>
HWY_INLINE Triple<V> sample_cosine_by_axis(const Triple<V>& normal, V u, V v) {
  const hn::DFromV<V> d;
  Triple<V> tangent, bitangent;
  axis_basis(normal, tangent, bitangent);
  const Pair<V> disk = sample_disk(u, v);
  const V up = hn::Sqrt(hn::Max(hn::Set(d, 1.0f) - u, hn::Zero(d)));
  return normalized(tangent * disk.x + bitangent * disk.y + normal * up);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
