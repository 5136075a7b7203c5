// Points of emissive triangles, as shaders/lib/lighting/emissive_lights.glsl draws them, a lane for
// every receiver. Included once per instruction set.
#if defined(HELIOGRAPH_KERNELS_EMISSIVE_LIGHTS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_EMISSIVE_LIGHTS_HPP
#undef HELIOGRAPH_KERNELS_EMISSIVE_LIGHTS_HPP
#else
#define HELIOGRAPH_KERNELS_EMISSIVE_LIGHTS_HPP
#endif

#include "render/kernels/simd/material/surface.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// A point of an emissive triangle.
struct EmissiveLanes {
  Float3 position;  // world
  Float3 normal;    // of the front face
  Float3 emission;  // radiance toward the receiver: 0 where the side that it sees does not shine
  Float density;    // per square metre; 0: nothing was drawn
};

/// Draws a triangle by `pick`, by its power, and a point of it by `within`, by area. A miss where
/// nothing shines; t is 0.
HWY_INLINE HitLanes draw_emissive(const SceneView& scene, const Float2& pick,
                                  const Float2& within) {
  HitLanes drawn;
  const auto count = static_cast<int>(scene.emissive.header->count);
  drawn.met = hn::Lt(zero(), number(static_cast<float>(count)));
  drawn.t = zero();
  drawn.instance = drawn.triangle = integer(0);
  const Mask upper = hn::Gt(within.y, within.x);
  const Float half = hn::Mul(number(0.5f), hn::Min(within.x, within.y));
  drawn.u = select(upper, half, hn::Sub(within.x, half));
  drawn.v = select(upper, hn::Sub(within.y, half), half);
  if (count == 0) return drawn;
  constexpr int stride = sizeof(shared::EmissiveTriangle) / 4;
  Integer entry =
      hn::Min(truncated(hn::Mul(pick.x, number(static_cast<float>(count)))), integer(count - 1));
  const Records slot(scene.emissive.triangles, entry, stride);
  const Float threshold = slot.real(HELIOGRAPH_WORD(shared::EmissiveTriangle, threshold));
  entry = select(hn::Lt(pick.y, threshold), entry,
                 slot.whole(HELIOGRAPH_WORD(shared::EmissiveTriangle, alias)));
  const Records chosen(scene.emissive.triangles, entry, stride);
  drawn.instance = chosen.whole(HELIOGRAPH_WORD(shared::EmissiveTriangle, instance));
  drawn.triangle = chosen.whole(HELIOGRAPH_WORD(shared::EmissiveTriangle, triangle));
  return drawn;
}

/// The share of power of triangles; 0 of those that are not in the table.
HWY_INLINE Float emissive_probability(const SceneView& scene, Integer instance, Integer triangle) {
  if (scene.emissive.header->count == 0) return zero();
  const Integer first = gather(scene.emissive.first, instance);
  const Mask listed = float_mask(hn::Gt(first, integer(-1)));  // no_emissive is -1
  const Integer entry = select(listed, hn::Add(first, triangle), integer(0));
  const Records chosen(scene.emissive.triangles, entry, sizeof(shared::EmissiveTriangle) / 4);
  return hn::IfThenElseZero(listed,
                            chosen.real(HELIOGRAPH_WORD(shared::EmissiveTriangle, probability)));
}

/// What of the emission arrives from surfaces that cover only in part.
template <bool one_level>
HWY_INLINE Float emissive_coverage(MaterialSlots<one_level>& slots, const HitRecords& records) {
  const Integer flags = records.material.whole(HELIOGRAPH_WORD(Material, flags));
  const auto has = [&](std::uint32_t flag) HWY_ATTR {
    const Integer bit = hn::And(flags, integer(static_cast<int>(flag)));
    return float_mask(hn::Ne(bit, integer(0)));
  };
  const Mask partial = hn::AndNot(has(shared::material_whole_alpha),
                                  has(shared::material_alpha_mask | shared::material_alpha_blend));
  if (none(partial)) return one();
  const TriangleLanes& t = records.triangle;
  const Float tint = t.between(t.a().color.w, t.b().color.w, t.c().color.w);
  const Float texel = slots.texel(HELIOGRAPH_WORD(Material, base_color_slot)).w;
  const Float alpha = records.material.four(HELIOGRAPH_WORD(Material, base_color)).w * tint * texel;
  const Float cutoff = records.material.real(HELIOGRAPH_WORD(Material, alpha_cutoff));
  const Float masked = hn::IfThenElseZero(hn::Ge(alpha, cutoff), one());
  return select(partial, select(has(shared::material_alpha_blend), alpha, masked), one());
}

/// `point` of draw_emissive() as `receiver` sees it by a cone of this width there and spread.
template <bool one_level>
HWY_INLINE EmissiveLanes emissive_sample(const SceneView& scene, const HitLanes& point,
                                         const Float3& receiver, Float width, Float spread) {
  EmissiveLanes s{numbers(0.0f), numbers(0.0f), numbers(0.0f), zero()};
  if (none(point.met)) return s;
  HitRecords records(scene, point);
  records.triangle.set_point(point.u, point.v);
  const TriangleLanes& t = records.triangle;
  s.position = records.world.point(t.position());
  const Float3 across = cross(records.world.direction(t.b().position - t.a().position),
                              records.world.direction(t.c().position - t.a().position)) *
                        records.handedness;
  const Float twice_area = hn::Sqrt(dot(across, across));
  const Mask solid = hn::Gt(twice_area, zero());
  const Float by_area = hn::Div(one(), select(solid, twice_area, one()));
  s.normal = across * by_area;
  const Float share = emissive_probability(scene, point.instance, point.triangle);
  s.density = hn::IfThenElseZero(solid, number(2.0f) * share * by_area);
  const Float3 to_receiver = receiver - s.position;
  const Float away = hn::Sqrt(dot(to_receiver, to_receiver));
  const Float cosine = hn::Div(dot(s.normal, to_receiver), at_least(away, 1e-20f));
  const Integer sides = hn::And(records.material.whole(HELIOGRAPH_WORD(Material, flags)),
                                integer(static_cast<int>(shared::material_double_sided)));
  const Mask shines =
      hn::And(solid, hn::Or(hn::Gt(cosine, zero()), float_mask(hn::Ne(sides, integer(0)))));
  if (none(shines)) return s;
  const LookupLanes lookup = texture_lookup(t, records.material, twice_area,
                                            hn::MulAdd(spread, away, width), hn::Abs(cosine));
  MaterialSlots<one_level> slots(scene, records.material, lookup);
  const Float coverage = emissive_coverage<one_level>(slots, records);
  const Float4 texel = slots.texel(HELIOGRAPH_WORD(Material, emissive_slot));
  const Float3 factor = records.material.triple(HELIOGRAPH_WORD(Material, emissive));
  s.emission = keep(shines, factor * Float3{texel.x, texel.y, texel.z} * coverage);
  return s;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
