// Weights that keep filters from crossing edges, as shaders/lib/denoise/edge_stopping.glsl has
// them. Exponents count octaves: multiplied by log2(e), they are powers of two. Included once per
// instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_EDGE_STOPPING_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_EDGE_STOPPING_HPP
#undef HELIOGRAPH_KERNELS_EDGE_STOPPING_HPP
#else
#define HELIOGRAPH_KERNELS_EDGE_STOPPING_HPP
#endif

#include <numbers>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr float octaves = std::numbers::log2e_v<float>;
/// The exponent from which edge_weight() counts: 512 keeps the binary point of a float where it is,
/// 127 is the bias of its exponent.
inline constexpr float weight_one = 512.0f + 127.0f;

/// edge_weight() of the shaders: 2^(exponent - weight_one) with the fraction in place of its power;
/// 0 where not `valid`. `exponent` must be less than 1024.
template <class M, class V>
HWY_INLINE V edge_weight(M valid, V exponent) {
  const hn::DFromV<V> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const auto fixed_point = hn::BitCast(du, hn::Max(exponent, hn::Set(d, 512.0f)));
  return hn::IfThenElseZero(valid, hn::BitCast(d, hn::ShiftLeft<9>(fixed_point)));
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
