// What surfaces that rays have met do with light: shaders/lib/scene/hit_material.glsl and
// coverage.glsl, a lane for every ray. Included once per instruction set.
#if defined(HELIOGRAPH_KERNELS_HIT_MATERIAL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_HIT_MATERIAL_HPP
#undef HELIOGRAPH_KERNELS_HIT_MATERIAL_HPP
#else
#define HELIOGRAPH_KERNELS_HIT_MATERIAL_HPP
#endif

#include "render/kernels/simd/material/surface.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

HWY_INLINE SurfaceMaterial<Float> material_of(const SurfaceLanes& s, const Float3& direction,
                                              const LobeLanes<Tag>& tables) {
  return make_material(tag, s.base_color, s.metallic, s.roughness, s.normal, s.geometric,
                       -direction, tables.split_sum);
}
HWY_INLINE LayeredMaterial<Float> material_of(const LayeredSurfaceLanes& s, const Float3& direction,
                                              const LobeLanes<Tag>& tables) {
  return make_material(tag, s.base_color, s.metallic, s.roughness, s.normal, s.geometric,
                       -direction, tables, s.layer);
}

/// Fraction of what enters that comes out behind.
HWY_INLINE Float transmission_of(const SurfaceLanes&) {
  return zero();
}
HWY_INLINE Float transmission_of(const LayeredSurfaceLanes& s) {
  return s.layer.transmission;
}

/// The factor on what is seen through a blended surface.
HWY_INLINE Float3 seen_behind(const SurfaceLanes& s, const SurfaceMaterial<Float>&) {
  const Float open = one() - s.alpha;
  return {open, open, open};
}
HWY_INLINE Float3 seen_behind(const LayeredSurfaceLanes& s, const LayeredMaterial<Float>& m) {
  const Float open = one() - s.alpha;
  return multiply_add(m.transmitted, s.alpha, {open, open, open});
}

/// Whether the camera sees nothing there: shaders/lib/scene/coverage.glsl. Tracers test the nearest
/// texel of a mask; the frame shows the filtered one.
HWY_INLINE Mask is_open(const SurfaceLanes& s, const Float3& direction) {
  const Mask back = hn::Gt(dot(s.front, direction), zero());
  const Mask masked = s.has(shared::material_alpha_mask);
  return hn::Or(hn::AndNot(s.has(shared::material_double_sided), back),
                hn::And(masked, hn::Lt(s.alpha, s.alpha_cutoff)));
}

/// Whether something of what is behind shows through the surface.
template <class Surface>
HWY_INLINE Mask is_blended(const Surface& s) {
  const Mask blends = s.has(shared::material_alpha_blend);
  if (none(blends)) return blends;
  const Float covered = hn::NegMulAdd(s.alpha, transmission_of(s), s.alpha);
  return hn::And(blends, hn::Lt(covered, number(shared::least_solid)));
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
