// Lights for host kernels: shaders/lib/lighting/lights.glsl and light_choice.glsl in vectors.
// Included once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_LIGHTS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_LIGHTS_HPP
#undef HELIOGRAPH_KERNELS_LIGHTS_HPP
#else
#define HELIOGRAPH_KERNELS_LIGHTS_HPP
#endif

#include <ranges>
#include <span>

#include "render/kernels/simd/area_lights.hpp"
#include "render/kernels/simd/material/layers.hpp"
#include "render/kernels/simd/ray_writer.hpp"
#include "render/kernels/simd/rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

inline bool has_area(const shared::Light& light) {
  return light.type >= shared::light_rectangle;
}

/// A punctual light's middle, as surfaces see it.
template <class V>
struct LightSample {
  Triple<V> direction;
  V distance;
  V attenuation;  // of the light's colour
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE LightSample<V> light_at(D d, const shared::Light& light, const Triple<V>& position) {
  const V one = hn::Set(d, 1.0f);
  if (light.type == shared::light_directional) {
    return {splat(d, -light.direction), hn::Set(d, 1e30f), one};
  }
  const Triple<V> to_light = splat(d, light.position) - position;
  const V squared = hn::Max(dot(to_light, to_light), hn::Set(d, 1e-8f));
  LightSample<V> s;
  s.distance = hn::Sqrt(squared);
  s.direction = to_light * (one / s.distance);
  s.attenuation = one / squared;
  if (light.range > 0.0f) {
    const V q = squared * hn::Set(d, 1.0f / (light.range * light.range));
    s.attenuation = s.attenuation * clamped(hn::NegMulAdd(q, q, one), 0.0f, 1.0f);
  }
  if (light.type == shared::light_spot) {
    const V cosine = hn::Neg(dot(splat(d, light.direction), s.direction));
    const V cone =
        clamped(hn::MulAdd(cosine, hn::Set(d, light.spot_scale), hn::Set(d, light.spot_offset)),
                0.0f, 1.0f);
    s.attenuation = s.attenuation * cone * cone;
  }
  return s;
}

/// Lanes that any of the light may reach, of those that `requested` names.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> reached(D d, const shared::Light& light, const Triple<V>& position,
                               hn::Mask<D> requested) {
  if (light.type == shared::light_directional || light.range <= 0.0f) return requested;
  const Triple<V> to_light = splat(d, light.position) - position;
  return hn::And(requested, hn::Lt(dot(to_light, to_light), hn::Set(d, light.range * light.range)));
}

/// Light that surfaces send to the eye from this light, unshadowed: radiance, 0 in lanes that are
/// not `requested`. `s`: of punctual lights. @return lanes that it reaches
template <class D, class Material, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> light_contribution(D d, const shared::Light& light, const SquareTexels& ltc,
                                          const Material& m, const Triple<V>& position,
                                          hn::Mask<D> requested, LightSample<V>& s,
                                          Triple<V>& radiance) {
  hn::Mask<D> lit = reached(d, light, position, requested);
  if (hn::AllFalse(d, lit)) return lit;
  if (has_area(light)) {
    radiance = area_contribution(d, light, ltc, m, position);
  } else {
    s = light_at(d, light, position);
    lit = hn::And(lit, is_lit_from(m, s.direction));
    if (hn::AllFalse(d, lit)) return lit;
    radiance = splat(d, light.color) * s.attenuation * shade_light_of_side(d, m, s.direction);
  }
  radiance = {hn::IfThenElseZero(lit, radiance.x), hn::IfThenElseZero(lit, radiance.y),
              hn::IfThenElseZero(lit, radiance.z)};
  return lit;
}

/// Light of all lights, unshadowed.
template <class D, class Material, class V = hn::Vec<D>>
HWY_INLINE Triple<V> direct_light(D d, std::span<const shared::Light> lights,
                                  const SquareTexels& ltc, const Material& m,
                                  const Triple<V>& position, hn::Mask<D> requested) {
  Triple<V> sum{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (const shared::Light& light : lights) {
    LightSample<V> s{sum, hn::Zero(d), hn::Zero(d)};
    Triple<V> radiance = sum;
    const auto lit = light_contribution(d, light, ltc, m, position, requested, s, radiance);
    if (!hn::AllFalse(d, lit)) sum = sum + radiance;
  }
  return sum;
}

/// One of the lights, in proportion to what it sends to the eye.
struct LightChoice {
  Float3 sum;    // of all contributions
  Float total;   // of their luminances; 0: there is none
  Float weight;  // luminance of its unshadowed contribution
  Float3 contribution;
  Float3 direction;  // toward its middle, of punctual lights
  Float distance;
  Float spread;    // tangent of its radius as seen from the surface
  Integer number;  // of the light
  bool areas;      // whether any lane chose a light with an area
};

HWY_INLINE LightChoice no_choice() {
  return {numbers(0.0f), zero(), one(),      numbers(0.0f), numbers(glm::vec3(0.0f, 1.0f, 0.0f)),
          one(),         zero(), integer(0), false};
}

/// Adds `sent`, for which the light is chosen where `pick`, which stays uniform, decides so.
HWY_INLINE Mask offer(LightChoice& choice, const Float3& sent, Float& pick) {
  const Float weight = luminance(sent);
  const Mask shines = hn::Gt(weight, zero());
  choice.sum = choice.sum + sent;
  choice.total = choice.total + hn::IfThenElseZero(shines, weight);
  const Float probability = weight / select(shines, choice.total, one());
  const Mask chosen = hn::And(shines, hn::Lt(pick, probability));
  const Float remaining = (pick - probability) / (one() - probability);
  pick = select(chosen, pick / probability, select(shines, remaining, pick));
  choice.weight = select(chosen, weight, choice.weight);
  choice.contribution = select(chosen, sent, choice.contribution);
  return chosen;
}

/// The chosen light is punctual.
HWY_INLINE void keep_way(LightChoice& choice, Mask chosen, const LightSample<Float>& s,
                         Float spread) {
  choice.direction = select(chosen, s.direction, choice.direction);
  choice.distance = select(chosen, s.distance, choice.distance);
  choice.spread = select(chosen, spread, choice.spread);
}

/// Offers one light, the same for all lanes.
template <class Material>
HWY_INLINE void offer_light(LightChoice& choice, const shared::Light& light, int light_number,
                            const SquareTexels& ltc, const Material& m, const Float3& position,
                            Mask requested, Float& pick) {
  LightSample<Float> s{numbers(0.0f), zero(), zero()};
  Float3 sent = numbers(0.0f);
  if (none(light_contribution(tag, light, ltc, m, position, requested, s, sent))) return;
  const Mask chosen = offer(choice, sent, pick);
  if (none(chosen)) return;
  choice.number = select(chosen, integer(light_number), choice.number);
  if (has_area(light)) {
    choice.areas = true;
    return;
  }
  const bool far = light.type == shared::light_directional;
  const Float radius = number(light.radius);
  keep_way(choice, chosen, s, far ? radius : radius / s.distance);
}

/// `pick` decides, and stays uniform.
template <class Material>
HWY_INLINE LightChoice choose_light(std::span<const shared::Light> lights, const SquareTexels& ltc,
                                    const Material& m, const Float3& position, Mask requested,
                                    Float& pick) {
  LightChoice choice = no_choice();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    offer_light(choice, lights[i], static_cast<int>(i), ltc, m, position, requested, pick);
  }
  return choice;
}

/// A point of an area light in proportion to the light that it sends to the eye, near enough.
/// @return where there is any
template <class Material>
HWY_NOINLINE Mask sample_lit_point(const shared::Light& light, const Material& m,
                                   const Float3& position, const Float2& u, Float pick,
                                   Float3& direction, Float& distance) {
  constexpr int area_candidates = 4;
  Float total = zero();
  for (int i = 0; i < area_candidates; ++i) {
    // Steps of the R2 sequence (Roberts 2018).
    const auto step = [i](Float v, float by) HWY_ATTR {
      const Float at = v + number(static_cast<float>(i) * by);
      return at - hn::Floor(at);
    };
    const Float2 at{step(u.x, 0.7548776662f), step(u.y, 0.5698402910f)};
    const AreaSample<Float> s = sample_area(light, position, at);
    const Float3 sent =
        numbers(light.color) * s.solid_angle * shade_light_of_side(tag, m, s.direction);
    const Float weight = hn::IfThenElseZero(is_lit_from(m, s.direction), luminance(sent));
    const Mask shines = hn::Gt(weight, zero());
    total = total + hn::IfThenElseZero(shines, weight);
    const Float probability = weight / select(shines, total, one());
    const Mask chosen = hn::And(shines, hn::Lt(pick, probability));
    const Float remaining = (pick - probability) / (one() - probability);
    pick = select(chosen, pick / probability, select(shines, remaining, pick));
    direction = select(chosen, s.direction, direction);
    distance = select(chosen, s.distance, distance);
  }
  return hn::Gt(total, zero());
}

/// Toward a point of the chosen light: light_ray() of light_choice.glsl, its direction and length.
/// `areas`: numbers of the lights that have an area, and of any others. Where a point is seen, the
/// ray begins at lit_side() of its direction.
/// @return where that is, of `requested`
template <class Material, class Numbers>
HWY_INLINE Mask aim(std::span<const shared::Light> lights, const Numbers& areas,
                    const LightChoice& choice, const Material& m, const Float3& position,
                    const Float2& u, Float pick, Mask requested, RayLanes& ray) {
  const Float2 disk = sample_disk(u.x, u.y);
  Float3 tangent, bitangent;
  orthonormal_basis(choice.direction, tangent, bitangent);
  ray.direction =
      normalized(multiply_add(tangent, disk.x * choice.spread,
                              multiply_add(bitangent, disk.y * choice.spread, choice.direction)));
  Float distance = choice.distance;
  Float3 middle = choice.direction;
  requested = hn::And(requested, hn::Gt(choice.total, zero()));
  if (choice.areas) {
    for (const std::uint32_t i : areas) {
      if (!has_area(lights[i])) continue;
      const Mask chosen =
          hn::And(requested, float_mask(hn::Eq(choice.number, integer(static_cast<int>(i)))));
      if (none(chosen)) continue;
      Float3 direction = ray.direction;
      Float away = distance;
      const Mask seen = sample_lit_point(lights[i], m, position, u, pick, direction, away);
      ray.direction = select(chosen, direction, ray.direction);
      middle = select(chosen, direction, middle);
      distance = select(chosen, away, distance);
      requested = hn::AndNot(hn::AndNot(seen, chosen), requested);
    }
  }
  // Geometry may lie where a light does and show it: it must not occlude itself.
  ray.t_max = distance * number(0.999f);
  // The light's disk may reach below the horizon, where nothing of it is seen.
  return hn::And(requested, hn::Gt(dot(ray.direction, lit_side(m, middle)), zero()));
}
template <class Material>
HWY_INLINE Mask aim(std::span<const shared::Light> lights, const LightChoice& choice,
                    const Material& m, const Float3& position, const Float2& u, Float pick,
                    Mask requested, RayLanes& ray) {
  const auto all = std::views::iota(0u, static_cast<std::uint32_t>(lights.size()));
  return aim(lights, all, choice, m, position, u, pick, requested, ray);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
