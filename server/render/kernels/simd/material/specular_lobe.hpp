// Drawing directions from the specular lobe, and which pixels do: shaders/lib/math/sampling.glsl
// and specular_pixels.glsl in vectors. Included once per instruction set; the guard is Google
// Highway's convention.
#if defined(HELIOGRAPH_KERNELS_SPECULAR_LOBE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_SPECULAR_LOBE_HPP
#undef HELIOGRAPH_KERNELS_SPECULAR_LOBE_HPP
#else
#define HELIOGRAPH_KERNELS_SPECULAR_LOBE_HPP
#endif

#include <numbers>

#include "render/kernels/simd/lanes.hpp"
#include "render/kernels/simd/material/layers.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/ray_writer.hpp"
#include "render/kernels/simd/rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

inline constexpr float distance_of_misses = 1e4f;  // metres
inline constexpr float farthest_hit =
    0.999f * distance_of_misses;  // what is hit beyond counts as there

using MaterialLanes = SurfaceMaterial<Float>;

/// Where traced pixels stand in a sequence of random numbers.
struct SequencePosition {
  std::uint32_t sample;
  std::uint32_t dimension;
};
inline SequencePosition sequence_position(const shared::FrameConstants& frame,
                                          std::uint32_t dimension, int scale) {
  if (scale == 1) return {frame.sample_index, dimension};
  return {frame.sample_index >> 2u, 16u + 4u * dimension + (frame.sample_index & 3u)};
}
inline RandomPairs<UnsignedTag> specular_pairs(const shared::FrameConstants& frame,
                                               std::uint32_t dimension, int scale) {
  const SequencePosition position = sequence_position(frame, dimension, scale);
  return {unsigned_tag, position.sample, position.dimension, frame.seed};
}
inline RandomNumbers<UnsignedTag> specular_numbers(const shared::FrameConstants& frame,
                                                   std::uint32_t dimension, int scale) {
  const SequencePosition position = sequence_position(frame, dimension, scale);
  return {unsigned_tag, position.sample, position.dimension, frame.seed};
}

/// The lobe's normal, or as close to it as keeps the reflected direction above the triangle.
HWY_INLINE Float3 reflecting_normal(const MaterialLanes& m, const Float3& normal) {
  const Float3 reflected = reflect(-m.eye, normal);
  const Float least = number(0.01f);
  const Float above = dot(reflected, m.geometric);
  const Mask stays = hn::Or(hn::Ge(above, least), hn::Le(dot(m.eye, m.geometric), zero()));
  if (all(stays)) return normal;
  const Float3 lifted = normalized(multiply_add(m.geometric, least - above, reflected));
  return select(stays, normal, normalized(m.eye + lifted));
}

/// A microfacet normal as seen from `view`, in the frame of the shading normal.
/// `alpha`: along x and along y.
HWY_INLINE Float3 sample_visible_normal(const Float3& view, const Float2& alpha, const Float2& u) {
  const Float3 stretched = normalized(Float3{alpha.x * view.x, alpha.y * view.y, view.z});
  const Float angle = u.x * number(2.0f * std::numbers::pi_v<float>);
  const Float z = hn::NegMulAdd(u.y, one() + stretched.z, one());
  const Float radius = hn::Sqrt(clamped(hn::NegMulAdd(z, z, one()), 0.0f, 1.0f));
  const Float x = hn::MulAdd(radius, hn::Cos(tag, angle), stretched.x);
  const Float y = hn::MulAdd(radius, hn::Sin(tag, angle), stretched.y);
  return normalized(Float3{alpha.x * x, alpha.y * y, at_least(z + stretched.z, 1e-7f)});
}
HWY_INLINE Float3 sample_visible_normal(const Float3& view, Float alpha, const Float2& u) {
  return sample_visible_normal(view, Float2{alpha, alpha}, u);
}

/// G2 / G1(v); 0 below the horizon.
HWY_INLINE Float visible_normal_weight(const Float3& view, const Float3& light,
                                       const Float2& alpha) {
  const Float toward_view = masked_length(view, alpha), toward_light = masked_length(light, alpha);
  const Float weight =
      light.z * (view.z + toward_view) / hn::MulAdd(light.z, toward_view, view.z * toward_light);
  return hn::IfThenElseZero(hn::Gt(light.z, zero()), weight);
}

/// Density per solid angle of the reflected direction `light`.
HWY_INLINE Float visible_normal_pdf(const Float3& view, const Float3& light, const Float2& alpha) {
  const Float3 half_vector = normalized(view + light);
  const Float masking = number(2.0f) * view.z / (view.z + masked_length(view, alpha));
  const Float density = masking * ggx_distribution(half_vector, alpha) / (number(4.0f) * view.z);
  return hn::IfThenElseZero(hn::Gt(half_vector.z, zero()), density);
}

struct SpecularSample {
  Float3 direction;  // world
  Float3 weight;     // BRDF x cos / pdf; 0 ends the path
  Float density;
  Float roughness;  // of the lobe
};

/// A direction of one lobe. Its weight is not multiplied by the reflectance at `v_dot_h` yet.
struct LobeSample {
  Float3 direction;
  Float v_dot_h, weight, density;
};

/// The frame of a lobe about its normal, whose x is the grain where it has one, and the direction
/// to the eye in it.
struct LobeFrame {
  Float3 normal, tangent, bitangent, view;
  Float2 alpha;
  HWY_INLINE LobeFrame(const MaterialLanes& m, const Float3& lobe_normal, Float roughness)
      : normal(reflecting_normal(m, lobe_normal)) {
    orthonormal_basis(normal, tangent, bitangent);
    alpha = {roughness * roughness, roughness * roughness};
    look_from(m.eye);
  }
  /// Of lanes that are not `coated` the base's lobe.
  HWY_INLINE LobeFrame(const LayeredMaterial<Float>& m, const Float3& lobe_normal, Float roughness,
                       Mask coated)
      : LobeFrame(m, lobe_normal, roughness) {
    if (!m.grained) return;
    const Mask grained = hn::AndNot(coated, hn::Gt(m.anisotropy, zero()));
    const Float3 along = grain_about(normal, m.grain);
    tangent = select(grained, along, tangent);
    bitangent = select(grained, cross(normal, along), bitangent);
    alpha.x = select(grained, lobe_alpha(roughness, m.anisotropy).x, alpha.x);
    look_from(m.eye);
  }

 private:
  HWY_INLINE void look_from(const Float3& eye) {
    view = normalized(
        Float3{dot(eye, tangent), dot(eye, bitangent), at_least(dot(eye, normal), 1e-3f)});
  }
};

HWY_INLINE LobeSample sample_lobe(const MaterialLanes& m, const LobeFrame& frame, const Float2& u) {
  const Float3& view = frame.view;
  const Float2& alpha = frame.alpha;
  const Float3 microfacet = sample_visible_normal(view, alpha, u);
  LobeSample s;
  s.v_dot_h = dot(view, microfacet);
  const Float3 light = microfacet * (number(2.0f) * s.v_dot_h) - view;
  s.direction = normalized(multiply_add(
      frame.tangent, light.x, multiply_add(frame.bitangent, light.y, frame.normal * light.z)));
  const Mask open = hn::Gt(dot(s.direction, m.geometric), zero());
  s.weight = hn::IfThenElseZero(open, visible_normal_weight(view, light, alpha));
  s.density =
      visible_normal_pdf(view, light, Float2{at_least(alpha.x, 1e-4f), at_least(alpha.y, 1e-4f)});
  return s;
}

HWY_INLINE Float3 microfacet_reflectance(const MaterialLanes& m, Float v_dot_h) {
  return multiply_add(m.f90_minus_f0, schlick_weight(v_dot_h), m.f0);
}

HWY_INLINE SpecularSample sample_specular(const MaterialLanes& m, const Float2& u) {
  const LobeSample s = sample_lobe(m, LobeFrame(m, m.normal, m.roughness), u);
  return {s.direction, microfacet_reflectance(m, s.v_dot_h) * s.weight, s.density, m.roughness};
}

/// How likely the coat's lobe is drawn.
HWY_INLINE Float coat_share(const LayeredMaterial<Float>& m) {
  const Mask has_coat = hn::Gt(m.coat_albedo, zero());
  const Float3& albedo = m.specular_albedo;
  const Float mean = (albedo.x + albedo.y + albedo.z) * number(1.0f / 3.0f);
  return hn::IfThenElseZero(has_coat, clamped(m.coat_albedo / at_least(mean, 1e-6f), 0.05f, 0.95f));
}

/// Of a coated surface one of the two lobes is drawn, in proportion to what each gives back.
HWY_INLINE SpecularSample sample_specular(const LayeredMaterial<Float>& m, Float2 u) {
  if (!m.coated && !m.grained) return sample_specular(static_cast<const MaterialLanes&>(m), u);
  const Float of_coat = coat_share(m);
  const Mask coated = hn::Lt(u.x, of_coat);
  const Float probability = select(coated, of_coat, one() - of_coat);
  u.x = select(coated, u.x, u.x - of_coat) / probability;
  const Float roughness = select(coated, m.coat_roughness, m.roughness);
  const LobeFrame frame(m, select(coated, m.coat_normal, m.normal), roughness, coated);
  const LobeSample s = sample_lobe(m, frame, u);
  const Float of_lobe = s.weight / probability;
  const Float coat =
      hn::MulAdd(m.coat_f90_minus_f0, schlick_weight(s.v_dot_h), m.coat_f0) * of_lobe;
  return {s.direction,
          select(coated, {coat, coat, coat}, microfacet_reflectance(m, s.v_dot_h) * of_lobe),
          s.density * probability, roughness};
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
