// Diffuse light from both sides of surfaces in one signal:
// shaders/lib/lighting/two_sided_light.glsl in vectors. Included once per instruction set; the
// guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_TWO_SIDED_LIGHT_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_TWO_SIDED_LIGHT_HPP
#undef HELIOGRAPH_KERNELS_TWO_SIDED_LIGHT_HPP
#else
#define HELIOGRAPH_KERNELS_TWO_SIDED_LIGHT_HPP
#endif

#include "render/kernels/simd/lanes.hpp"
#include "render/kernels/simd/material/layers.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

struct SideShares {
  Float3 near, behind;
  Float pick_behind;  // probability of a ray to the other side, in proportion to its light
};

template <class Material>
HWY_INLINE SideShares side_shares(const Material& m) {
  const Float3 both = spread_albedo(m);
  const auto over = [](Float value) HWY_ATTR { return one() / at_least(value, 1e-6f); };
  const Float3 by{over(both.x), over(both.y), over(both.z)};
  const Float behind = luminance(transmitted_albedo(m)) / at_least(luminance(both), 1e-6f);
  return {wide_albedo(m) * by, transmitted_albedo(m) * by, behind};
}

HWY_INLINE Float pack_side_share(const Float3& share) {
  const auto tenth = [](Float value) HWY_ATTR {
    return truncated(hn::MulAdd(clamped(value, 0.0f, 1.0f), number(1023.0f), number(0.5f)));
  };
  const Integer color = hn::Or(
      tenth(share.x), hn::Or(hn::ShiftLeft<10>(tenth(share.y)), hn::ShiftLeft<20>(tenth(share.z))));
  return as_float(hn::Or(color, integer(static_cast<int>(1u << 31u))));
}

/// White where nothing was packed.
HWY_INLINE Float3 unpack_side_share(Float packed) {
  const Unsigned words = as_unsigned(packed);
  const Mask shared_out = float_mask(hn::Ne(as_integer(packed), integer(0)));
  const auto tenth = [](Unsigned shifted) HWY_ATTR {
    return to_float(as_integer(hn::And(shifted, bits(1023u)))) * number(1.0f / 1023.0f);
  };
  return select(
      shared_out,
      Float3{tenth(words), tenth(hn::ShiftRight<10>(words)), tenth(hn::ShiftRight<20>(words))},
      numbers(1.0f));
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
