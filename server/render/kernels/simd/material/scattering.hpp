// What paths meet by each lobe of a surface, and how likely it is: scatter() and scattered_light()
// of shaders/reference/reference_bounce.comp in vectors. Included once per instruction set; the
// guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_SCATTERING_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_SCATTERING_HPP
#undef HELIOGRAPH_KERNELS_SCATTERING_HPP
#else
#define HELIOGRAPH_KERNELS_SCATTERING_HPP
#endif

#include <numbers>

#include "render/kernels/simd/material/specular_lobe.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Of lobes that are wide enough for a light to be met by chance.
inline constexpr float least_scattering_roughness = 0.1f;

/// Of light that a path meets by chance with `density`, where it is also sampled with `other`: two
/// ways lead there, each weighed by how likely it is (Veach and Guibas 1995).
HWY_INLINE Float mis_weight(Float density, Float other) {
  const Mask sampled = hn::Gt(other, zero());
  return select(sampled, density / select(sampled, density + other, one()), one());
}

/// How likely paths take each lobe, and the way through the surface.
struct LobeProbabilities {
  Float specular, through;
  Float behind;  // the diffuse lobe at the other side
  Float wide;
};

HWY_INLINE LobeProbabilities lobe_probabilities(Float specular, Float through, Float behind,
                                                Float wide) {
  const Float sum = at_least(specular + wide + through + behind, 1e-6f);
  LobeProbabilities of{specular / sum, through / sum, behind / sum, zero()};
  of.wide = one() - of.specular - of.through - of.behind;
  return of;
}
HWY_INLINE LobeProbabilities lobe_probabilities(const MaterialLanes& m) {
  return lobe_probabilities(luminance(m.specular_albedo), zero(), zero(),
                            luminance(wide_albedo(m)));
}
HWY_INLINE LobeProbabilities lobe_probabilities(const LayeredMaterial<Float>& m) {
  return lobe_probabilities(luminance(m.specular_albedo), luminance(m.transmitted),
                            luminance(m.diffuse_transmitted), luminance(wide_albedo(m)));
}

/// BRDF x cosine of the white sheen.
HWY_INLINE Float3 sheen_light(const LayeredMaterial<Float>& m, const Float3& l) {
  const Float n_dot_l = at_least(dot(m.normal, l), 0.0f);
  const Float n_dot_h = clamped(dot(m.normal, normalized(l + m.eye)), 0.0f, 1.0f);
  return m.sheen * (sheen_lobe(n_dot_h, n_dot_l, m.n_dot_v, m.sheen_roughness) * n_dot_l);
}

/// BRDF x cosine of the lobes that are drawn by the cosine: diffuse, sheen.
HWY_INLINE Float3 wide_light(const MaterialLanes& m, const Float3& l) {
  return m.diffuse_albedo * cosine_density(dot(m.normal, l));
}
HWY_INLINE Float3 wide_light(const LayeredMaterial<Float>& m, const Float3& l) {
  const Float3 light = wide_light(static_cast<const MaterialLanes&>(m), l);
  return m.fuzzy ? light + sheen_light(m, l) : light;
}

/// The same over that density.
HWY_INLINE Float3 wide_weight(const MaterialLanes& m, const Float3&) {
  return m.diffuse_albedo;
}
HWY_INLINE Float3 wide_weight(const LayeredMaterial<Float>& m, const Float3& l) {
  if (!m.fuzzy) return m.diffuse_albedo;
  const Float by_cosine = number(std::numbers::pi_v<float>) / at_least(dot(m.normal, l), 1e-4f);
  return m.diffuse_albedo + sheen_light(m, l) * by_cosine;
}

/// What a specular lobe sends to the eye of light along -l but for the reflectance at `v_dot_h`,
/// BRDF x cosine, and how likely sample_lobe() draws it.
struct LobeValue {
  Float v_dot_h, reflected, density;
};

HWY_INLINE LobeValue lobe_value(const LobeFrame& frame, const Float3& l) {
  const Float3& view = frame.view;
  const Float2& alpha = frame.alpha;
  const Float3 light{dot(l, frame.tangent), dot(l, frame.bitangent), dot(l, frame.normal)};
  const Mask above = hn::Gt(light.z, zero());
  LobeValue value;
  value.density = hn::IfThenElseZero(above, visible_normal_pdf(view, light, alpha));
  value.reflected =
      hn::IfThenElseZero(above, visible_normal_weight(view, light, alpha) * value.density);
  value.v_dot_h = dot(view, normalized(view + light));
  return value;
}

/// Lanes in which light that is sampled falls into a lobe of this roughness.
HWY_INLINE Mask is_scattering(Float roughness) {
  return hn::Ge(roughness, number(least_scattering_roughness));
}

/// `value` over the densities of both ways, in lanes whose lobe scatters. `probability`: that the
/// path takes the lobe.
HWY_INLINE Float lobe_weight(const LobeValue& value, Float roughness, Float density,
                             Float probability) {
  const Float both = hn::MulAdd(probability, value.density, density);
  return hn::IfThenElseZero(is_scattering(roughness), value.reflected / at_least(both, 1e-30f));
}

/// Of the base's lobe.
HWY_INLINE Float3 scattered_base(const MaterialLanes& m, const LobeFrame& frame, const Float3& l,
                                 Float density, Float probability) {
  const LobeValue value = lobe_value(frame, l);
  return microfacet_reflectance(m, value.v_dot_h) *
         lobe_weight(value, m.roughness, density, probability);
}

HWY_INLINE Float3 scattered_specular(const MaterialLanes& m, const Float3& l, Float density,
                                     Float probability) {
  if (none(is_scattering(m.roughness))) return numbers(0.0f);
  return scattered_base(m, LobeFrame(m, m.normal, m.roughness), l, density, probability);
}
HWY_INLINE Float3 scattered_specular(const LayeredMaterial<Float>& m, const Float3& l,
                                     Float density, Float probability) {
  const auto& base = static_cast<const MaterialLanes&>(m);
  if (!m.coated && !m.grained) return scattered_specular(base, l, density, probability);
  const Float of_coat = coat_share(m);
  const LobeFrame frame(m, m.normal, m.roughness, hn::Lt(zero(), zero()));
  const Float3 light = scattered_base(m, frame, l, density, probability * (one() - of_coat));
  if (!m.coated) return light;
  const LobeFrame coat_frame(base, m.coat_normal, m.coat_roughness);
  const LobeValue value = lobe_value(coat_frame, l);
  const Float coat = hn::MulAdd(m.coat_f90_minus_f0, schlick_weight(value.v_dot_h), m.coat_f0) *
                     lobe_weight(value, m.coat_roughness, density, probability * of_coat);
  return {light.x + coat, light.y + coat, light.z + coat};
}

/// BSDF x cosine over the density of `l`, which was drawn with `density` to sample a light, lobe by
/// lobe: each with the weight that a path's own choice leaves to it.
template <class Material>
HWY_INLINE Float3 scattered_light(const Material& m, const Float3& l, Float density, bool diffuse,
                                  bool specular) {
  const LobeProbabilities lobes = lobe_probabilities(m);
  Float3 sent = numbers(0.0f);
  if (diffuse) {
    const Float cosine = dot(l, m.normal);
    const Float by_cosine = lobes.wide * cosine_density(cosine);
    const Float both = at_least(density + at_least(by_cosine, 0.0f), 1e-30f);
    sent = keep(hn::Gt(cosine, zero()), wide_light(m, l) * (one() / both));
  }
  if (specular) sent = sent + scattered_specular(m, l, density, lobes.specular);
  if (!scatters_through(m)) return sent;
  const Float cosine = cosine_density(at_least(hn::Neg(dot(l, m.normal)), 0.0f));
  const Float both = at_least(hn::MulAdd(lobes.behind, cosine, density), 1e-30f);
  const Float3 through = transmitted_albedo(m) * (diffuse ? cosine / both : zero());
  return select(hn::Gt(dot(l, m.geometric), zero()), sent, through);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
