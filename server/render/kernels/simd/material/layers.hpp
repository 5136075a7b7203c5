// Surfaces under clear coat and sheen, with grain and specular parameters of their own, for host
// kernels: what shaders/lib/lighting/brdf.glsl and environment.glsl make of layers, in vectors.
// Kernels of scenes without layers use material.hpp alone. Included once per instruction set; the
// guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_LAYERS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_LAYERS_HPP
#undef HELIOGRAPH_KERNELS_LAYERS_HPP
#else
#define HELIOGRAPH_KERNELS_LAYERS_HPP
#endif

#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/material/material.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// What extensions make of a point of a surface.
template <class V>
struct SurfaceLayer {
  Triple<V> f0;  // reflectance of the dielectric at normal incidence
  V f90;
  Triple<V> coat_normal;
  V coat, coat_roughness;
  Triple<V> sheen;
  V sheen_roughness;
  V transmission;
  Triple<V> transmitted;
  Triple<V> grain;         // direction in which the surface is rougher, unit length
  V anisotropy;            // strength; 0: the surface has no grain
  V diffuse_transmission;  // fraction of the diffuse light that leaves at the other side
  Triple<V> diffuse_tint;  // and its colour
};

template <class V>
struct LayeredMaterial : SurfaceMaterial<V> {
  Triple<V> transmitted;          // what passes straight through
  Triple<V> diffuse_transmitted;  // albedo toward the eye of diffuse light from the other side
  Triple<V> coat_normal;
  V coat_n_dot_v;
  V coat_roughness;
  V coat_f0, coat_f90_minus_f0;
  V coat_albedo;    // its part of specular_albedo; 0: there is no coat
  Triple<V> sheen;  // factor on the lobe; 0: there is none
  V sheen_roughness;
  Triple<V> sheen_albedo;
  Triple<V> grain;              // perpendicular to the normal, unit length
  V anisotropy;                 // 0: there is no grain
  bool coated, fuzzy, grained;  // whether any lane has a coat, sheen, or grain
  bool translucent;             // or scatters light to its other side
};

/// Alpha of the base's specular lobe along the grain and across it (KHR_materials_anisotropy).
template <class V>
HWY_INLINE Pair<V> lobe_alpha(V roughness, V anisotropy) {
  const V alpha = roughness * roughness;
  return {mix(alpha, hn::Set(hn::DFromV<V>(), 1.0f), anisotropy * anisotropy), alpha};
}

/// `grain` turned into the plane of `normal`.
template <class V>
HWY_INLINE Triple<V> grain_about(const Triple<V>& normal, const Triple<V>& grain) {
  const hn::DFromV<V> d;
  const Triple<V> along = grain - normal * dot(normal, grain);
  const V squared = hn::Max(dot(along, along), hn::Set(d, 1e-12f));
  return along * (hn::Set(d, 1.0f) / hn::Sqrt(squared));
}

/// Dims all that lies under another lobe.
template <class V>
HWY_INLINE void cover(LayeredMaterial<V>& m, V under) {
  for (Triple<V>* const part :
       {&m.f0, &m.f90_minus_f0, &m.specular_albedo, &m.diffuse_albedo, &m.transmitted,
        &m.diffuse_transmitted, &m.sheen, &m.sheen_albedo}) {
    *part = *part * under;
  }
}

template <class V>
HWY_INLINE V largest_of(const Triple<V>& v) {
  return hn::Max(v.x, hn::Max(v.y, v.z));
}

/// Of `lanes`: others keep what they have.
template <class V, class M>
HWY_INLINE void add_sheen(LayeredMaterial<V>& m, const SurfaceLayer<V>& layer, V albedo, M lanes) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  const Triple<V> given = layer.sheen * hn::IfThenElseZero(lanes, hn::Min(albedo, one));
  cover(m, one - largest_of(given));
  m.sheen = layer.sheen * hn::IfThenElseZero(lanes, one / hn::Max(albedo, one));
  m.sheen_roughness = layer.sheen_roughness;
  m.sheen_albedo = given;
}

/// Of `lanes`, likewise. `split` is looked up at the coat's roughness and its own n.v.
template <class V, class M>
HWY_INLINE void add_coat(LayeredMaterial<V>& m, const SurfaceLayer<V>& layer, const Pair<V>& split,
                         M lanes) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f), f0 = hn::Set(d, dielectric_f0);
  const V whole = split.x + split.y;
  const V energy_compensation = one / hn::Max(whole, hn::Set(d, 1e-3f)) - one;
  const V scale = hn::IfThenElseZero(lanes, layer.coat * hn::MulAdd(f0, energy_compensation, one));
  m.coat_normal = layer.coat_normal;
  m.coat_roughness = layer.coat_roughness;
  m.coat_f0 = scale * f0;
  m.coat_f90_minus_f0 = scale * (one - f0);
  m.coat_albedo = hn::Min(hn::MulAdd(m.coat_f0, whole, m.coat_f90_minus_f0 * split.y), one);
  cover(m, one - m.coat_albedo);
  const auto add = [&](V& albedo) HWY_ATTR { albedo = albedo + m.coat_albedo; };
  add(m.specular_albedo.x);
  add(m.specular_albedo.y);
  add(m.specular_albedo.z);
}

/// The tables of the lobes in vectors.
template <class D>
struct LobeLanes {
  SquareTable<D> split_sum, sheen;
  HWY_INLINE explicit LobeLanes(const LobeTables& tables)
      : split_sum(tables.split_sum), sheen(tables.sheen) {}
};

/// The base layer, before any other lobe covers it.
template <class D, class V = hn::Vec<D>>
HWY_INLINE LayeredMaterial<V> make_base(D d, const Triple<V>& base_color, V metallic, V roughness,
                                        const Triple<V>& normal, const Triple<V>& geometric,
                                        const Triple<V>& eye, const Pair<V>& split,
                                        const SurfaceLayer<V>& layer) {
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  LayeredMaterial<V> m;
  m.normal = normal;
  m.geometric = geometric;
  m.eye = eye;
  m.n_dot_v = clamped(dot(normal, eye), 1e-3f, 1.0f);
  m.roughness = roughness;
  const V whole = split.x + split.y, rest = one - metallic;
  const V energy_compensation = one / hn::Max(whole, hn::Set(d, 1e-3f)) - one;
  Triple<V> albedo;
  const auto channel = [&](V color, V of_f0, V& f0, V& f90_minus_f0, V& specular,
                           V& given) HWY_ATTR {
    const V scale = hn::MulAdd(of_f0, energy_compensation, one);
    const V dielectric = rest * scale;
    const V metal = metallic * hn::MulAdd(color, energy_compensation, one);
    f0 = hn::MulAdd(dielectric, of_f0, metal * color);
    f90_minus_f0 = hn::MulAdd(dielectric, layer.f90 - of_f0, metal * (one - color));
    specular = hn::MulAdd(f0, whole, f90_minus_f0 * split.y);
    given = hn::MulAdd(of_f0, split.x, layer.f90 * split.y) * scale;
  };
  channel(base_color.x, layer.f0.x, m.f0.x, m.f90_minus_f0.x, m.specular_albedo.x, albedo.x);
  channel(base_color.y, layer.f0.y, m.f0.y, m.f90_minus_f0.y, m.specular_albedo.y, albedo.y);
  channel(base_color.z, layer.f0.z, m.f0.z, m.f90_minus_f0.z, m.specular_albedo.z, albedo.z);
  const V entering = rest * (one - hn::Min(largest_of(albedo), one));
  const V scattered = entering * (one - layer.transmission);
  m.diffuse_albedo = base_color * scattered;
  m.diffuse_transmitted = {zero, zero, zero};
  m.translucent = !hn::AllFalse(d, hn::Gt(layer.diffuse_transmission, zero));
  if (m.translucent) {
    m.diffuse_albedo = base_color * (scattered * (one - layer.diffuse_transmission));
    m.diffuse_transmitted = layer.diffuse_tint * (scattered * layer.diffuse_transmission);
  }
  m.transmitted = layer.transmitted * base_color * entering;
  m.coat_normal = normal;
  m.coat_n_dot_v = m.n_dot_v;
  m.coat_roughness = m.coat_f0 = m.coat_f90_minus_f0 = m.coat_albedo = m.sheen_roughness = zero;
  m.sheen = m.sheen_albedo = {zero, zero, zero};
  m.grain = layer.grain;
  m.anisotropy = layer.anisotropy;
  m.coated = m.fuzzy = m.grained = false;
  return m;
}

/// surface_material() of shaders/lib/lighting/environment.glsl
template <class D, class V = hn::Vec<D>>
HWY_INLINE LayeredMaterial<V> make_material(D d, const Triple<V>& base_color, V metallic,
                                            V roughness, const Triple<V>& normal,
                                            const Triple<V>& geometric, const Triple<V>& eye,
                                            const LobeLanes<D>& tables,
                                            const SurfaceLayer<V>& layer) {
  const V zero = hn::Zero(d), n_dot_v = clamped(dot(normal, eye), 1e-3f, 1.0f);
  const auto grained = hn::Gt(layer.anisotropy, zero);
  const bool any_grain = !hn::AllFalse(d, grained);
  V round = roughness;  // of the lobe without grain that stands for one with it in the table
  if (any_grain) {
    const Pair<V> alpha = lobe_alpha(roughness, layer.anisotropy);
    round = hn::IfThenElse(grained, hn::Sqrt(hn::Sqrt(alpha.x * alpha.y)), roughness);
  }
  LayeredMaterial<V> m = make_base(d, base_color, metallic, roughness, normal, geometric, eye,
                                   tables.split_sum.at(n_dot_v, round), layer);
  if (any_grain) {
    m.grained = true;
    m.grain = grain_about(normal, layer.grain);
  }
  const auto fuzzy = hn::Gt(largest_of(layer.sheen), zero);
  if (!hn::AllFalse(d, fuzzy)) {
    m.fuzzy = true;
    add_sheen(m, layer, tables.sheen.one_at(n_dot_v, layer.sheen_roughness), fuzzy);
  }
  const auto coated = hn::Gt(layer.coat, zero);
  if (!hn::AllFalse(d, coated)) {
    m.coated = true;
    m.coat_n_dot_v = clamped(dot(layer.coat_normal, eye), 1e-3f, 1.0f);
    add_coat(m, layer, tables.split_sum.at(m.coat_n_dot_v, layer.coat_roughness), coated);
  }
  return m;
}

template <class V>
HWY_INLINE Triple<V> wide_albedo(const LayeredMaterial<V>& m) {
  return m.fuzzy ? m.diffuse_albedo + m.sheen_albedo : m.diffuse_albedo;
}

template <class V>
HWY_INLINE bool scatters_through(const LayeredMaterial<V>& m) {
  return m.translucent;
}
template <class V>
HWY_INLINE const Triple<V>& transmitted_albedo(const LayeredMaterial<V>& m) {
  return m.diffuse_transmitted;
}

/// What spreads widely of light from both sides.
template <class V, template <class> class Material>
HWY_INLINE Triple<V> spread_albedo(const Material<V>& m) {
  if (!scatters_through(m)) return wide_albedo(m);
  return wide_albedo(m) + transmitted_albedo(m);
}

/// The environment's diffuse light, as if nothing hid it. `irradiance(normal)`: over pi.
template <class V, template <class> class Material, class Irradiance>
HWY_INLINE Triple<V> environment_diffuse(const Material<V>& m, const Irradiance& irradiance) {
  const Triple<V> light = wide_albedo(m) * irradiance(m.normal);
  if (!scatters_through(m)) return light;
  return light + transmitted_albedo(m) * irradiance(-m.normal);
}

/// Lanes that get light from direction `l`, of any length.
template <class V, template <class> class Material>
HWY_INLINE auto is_lit_from(const Material<V>& m, const Triple<V>& l) {
  const V zero = hn::Zero(hn::DFromV<V>());
  const auto above = hn::Gt(dot(m.geometric, l), zero);
  if (!scatters_through(m)) return above;
  return hn::Or(above, hn::Gt(largest_of(transmitted_albedo(m)), zero));
}

/// The triangle's normal on the side that is lit from direction `l`.
template <class V, template <class> class Material>
HWY_INLINE Triple<V> lit_side(const Material<V>& m, const Triple<V>& l) {
  if (!scatters_through(m)) return m.geometric;
  const V zero = hn::Zero(hn::DFromV<V>());
  const auto behind =
      hn::And(hn::Gt(largest_of(transmitted_albedo(m)), zero), hn::Le(dot(m.geometric, l), zero));
  return select(behind, -m.geometric, m.geometric);
}

template <class V>
HWY_INLINE V narrower_roughness(const LayeredMaterial<V>& m) {
  if (!m.coated) return m.roughness;
  const auto has_coat = hn::Gt(m.coat_albedo, hn::Zero(hn::DFromV<V>()));
  return hn::IfThenElse(has_coat, hn::Min(m.coat_roughness, m.roughness), m.roughness);
}

/// Part of specular_albedo that is not the coat's.
template <class V>
HWY_INLINE Triple<V> under_coat_albedo(const LayeredMaterial<V>& m) {
  if (!m.coated) return m.specular_albedo;
  return {m.specular_albedo.x - m.coat_albedo, m.specular_albedo.y - m.coat_albedo,
          m.specular_albedo.z - m.coat_albedo};
}

/// z of a direction over its masking, for an alpha along x and one along y.
template <class V>
HWY_INLINE V masked_length(const Triple<V>& direction, const Pair<V>& alpha) {
  const V x = alpha.x * direction.x, y = alpha.y * direction.y;
  return hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, direction.z * direction.z)));
}

/// GGX with an alpha for x and one for y; `h` in the frame of the lobe.
template <class V>
HWY_INLINE V ggx_distribution(const Triple<V>& h, const Pair<V>& alpha) {
  const hn::DFromV<V> d;
  const V x = h.x / alpha.x, y = h.y / alpha.y;
  const V squared = hn::MulAdd(x, x, hn::MulAdd(y, y, h.z * h.z));
  return hn::Set(d, std::numbers::inv_pi_v<float>) / (alpha.x * alpha.y * squared * squared);
}

/// D V n.l of the base's lobe in lanes with grain; `h` between the eye and the light along -l.
template <class V>
HWY_INLINE V grained_lobe(const LayeredMaterial<V>& m, const Triple<V>& l, const Triple<V>& h) {
  const hn::DFromV<V> d;
  const V least = hn::Set(d, 2e-3f);
  Pair<V> alpha = lobe_alpha(m.roughness, m.anisotropy);
  alpha = {hn::Max(alpha.x, least), hn::Max(alpha.y, least)};
  const Triple<V> across = cross_of(m.normal, m.grain);
  const V n_dot_l = hn::Max(dot(m.normal, l), hn::Zero(d));
  const Triple<V> light{dot(m.grain, l), dot(across, l), n_dot_l};
  const Triple<V> view{dot(m.grain, m.eye), dot(across, m.eye), m.n_dot_v};
  const Triple<V> middle{dot(m.grain, h), dot(across, h), clamped(dot(m.normal, h), 0.0f, 1.0f)};
  const V masked =
      hn::MulAdd(n_dot_l, masked_length(view, alpha), m.n_dot_v * masked_length(light, alpha));
  return ggx_distribution(middle, alpha) * hn::Set(d, 0.5f) * n_dot_l /
         hn::Max(masked, hn::Set(d, 1e-7f));
}

/// The normal about which the eye sees what the base's lobe reflects: bent along the grain.
template <class V>
HWY_INLINE Triple<V> reflection_normal(const LayeredMaterial<V>& m) {
  if (!m.grained) return m.normal;
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1.0f);
  const Triple<V> across = cross_of(m.normal, m.grain);
  const Triple<V> along = m.eye - across * dot(m.eye, across);
  const V size = hn::Max(dot(along, along), hn::Set(d, 1e-12f));
  const Triple<V> bent = along * (one / hn::Sqrt(size));
  V straight = hn::NegMulAdd(m.anisotropy, one - m.roughness, one);
  straight = straight * straight;
  straight = straight * straight;
  return select(hn::Gt(m.anisotropy, hn::Zero(d)), normalized(mix(bent, m.normal, straight)),
                m.normal);
}

template <class V, class Reflection>
HWY_INLINE Triple<V> environment_specular(const LayeredMaterial<V>& m,
                                          const Reflection& reflection) {
  const Triple<V> light = under_coat_albedo(m) * reflection(reflection_normal(m), m.roughness);
  if (!m.coated) return light;
  return light + reflection(m.coat_normal, m.coat_roughness) * m.coat_albedo;
}

/// D V of the white sheen.
template <class V>
HWY_INLINE V sheen_lobe(V n_dot_h, V n_dot_l, V n_dot_v, V roughness) {
  const hn::DFromV<V> d;
  constexpr float least_sheen_roughness = 0.07f;
  const V one = hn::Set(d, 1.0f), r = hn::Max(roughness, hn::Set(d, least_sheen_roughness));
  const V sharpness = one / (r * r);
  const V sine2 = hn::Max(hn::NegMulAdd(n_dot_h, n_dot_h, one), hn::Set(d, 1e-7f));
  const V power = hn::Exp(d, hn::Log(d, sine2) * sharpness * hn::Set(d, 0.5f));
  const V distribution =
      (hn::Set(d, 2.0f) + sharpness) * power * hn::Set(d, 0.5f * std::numbers::inv_pi_v<float>);
  const V across = hn::Max(hn::NegMulAdd(n_dot_l, n_dot_v, n_dot_l + n_dot_v), hn::Set(d, 1e-4f));
  return distribution / (hn::Set(d, 4.0f) * across);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> shade_light(D d, const LayeredMaterial<V>& m, const Triple<V>& l) {
  const V zero = hn::Zero(d);
  Triple<V> light = shade_light(d, static_cast<const SurfaceMaterial<V>&>(m), l);
  if (!m.coated && !m.fuzzy && !m.grained) return light;
  const Triple<V> h = normalized(l + m.eye);
  if (m.grained) {
    const V schlick = schlick_weight(dot(m.eye, h));
    const V lobe = grained_lobe(m, l, h);
    const V spread = hn::Max(dot(m.normal, l), zero) * hn::Set(d, std::numbers::inv_pi_v<float>);
    const Triple<V> with_grain =
        (m.f0 + m.f90_minus_f0 * schlick) * lobe + m.diffuse_albedo * spread;
    light = select(hn::Gt(m.anisotropy, zero), with_grain, light);
  }
  if (m.coated) {
    const V n_dot_l = hn::Max(dot(m.coat_normal, l), zero);
    const V n_dot_h = clamped(dot(m.coat_normal, h), 0.0f, 1.0f);
    const V reflectance = hn::MulAdd(m.coat_f90_minus_f0, schlick_weight(dot(m.eye, h)), m.coat_f0);
    const V coat = reflectance * specular_lobe(n_dot_h, n_dot_l, m.coat_n_dot_v, m.coat_roughness);
    light = {light.x + coat, light.y + coat, light.z + coat};
  }
  if (m.fuzzy) {
    const V n_dot_l = hn::Max(dot(m.normal, l), zero);
    const V n_dot_h = clamped(dot(m.normal, h), 0.0f, 1.0f);
    light =
        light + m.sheen * (sheen_lobe(n_dot_h, n_dot_l, m.n_dot_v, m.sheen_roughness) * n_dot_l);
  }
  return light;
}

/// BSDF x cosine for light arriving along -l from either side of the triangle.
template <class D, template <class> class Material, class V = hn::Vec<D>>
HWY_INLINE Triple<V> shade_light_of_side(D d, const Material<V>& m, const Triple<V>& l) {
  const Triple<V> near = shade_light(d, m, l);
  if (!scatters_through(m)) return near;
  const V zero = hn::Zero(d), cosine = hn::Max(hn::Neg(dot(m.normal, l)), zero);
  const Triple<V> through =
      transmitted_albedo(m) * (cosine * hn::Set(d, std::numbers::inv_pi_v<float>));
  return select(hn::Gt(dot(m.geometric, l), zero), near, through);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
