// Surfaces and punctual lights for host kernels: shaders/lib/lighting/brdf.glsl,
// gbuffer_material.glsl and lights.glsl in vectors. Included once per instruction set; the guard is
// Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_MATERIAL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_MATERIAL_HPP
#undef HELIOGRAPH_KERNELS_MATERIAL_HPP
#else
#define HELIOGRAPH_KERNELS_MATERIAL_HPP
#endif

#include <numbers>

#include "render/kernels/simd/pixels.hpp"
#include "shaders/shared/scene.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

inline constexpr float dielectric_f0 = 0.04f;

template <class V>
struct SurfaceMaterial {
  Triple<V> normal;
  Triple<V> geometric;
  Triple<V> eye;
  V n_dot_v;
  V roughness;
  Triple<V> f0;
  Triple<V> f90_minus_f0;
  Triple<V> specular_albedo;
  Triple<V> diffuse_albedo;
};

/// A square table of two floats, read with linear filtering, clamped at its edges.
template <class D>
class SquareTable {
  using V = hn::Vec<D>;
  using DI = hn::RebindToSigned<D>;
  using VI = hn::Vec<DI>;

 public:
  HWY_INLINE SquareTable(const gpu::HostView& texels, int size)
      : texels_(row_of<const float>(texels, 0)),
        pitch_(static_cast<int>(texels.row_pitch / sizeof(float))),
        size_(size) {}

  HWY_INLINE Pair<V> at(V u, V v) const {
    const V half = hn::Set(d_, 0.5f), scale = hn::Set(d_, static_cast<float>(size_));
    const V x = hn::MulSub(u, scale, half), y = hn::MulSub(v, scale, half);
    const V x0 = hn::Floor(x), y0 = hn::Floor(y);
    const V fx = x - x0, fy = y - y0;
    const VI left = inside(x0, 0), right = inside(x0, 1);
    const VI above = hn::Mul(inside(y0, 0), hn::Set(di_, pitch_));
    const VI below = hn::Mul(inside(y0, 1), hn::Set(di_, pitch_));
    const Quad<V> top = two_texels(above, left, right), bottom = two_texels(below, left, right);
    return {mix(mix(top.x, top.z, fx), mix(bottom.x, bottom.z, fx), fy),
            mix(mix(top.y, top.w, fx), mix(bottom.y, bottom.w, fx), fy)};
  }

 private:
  HWY_INLINE VI inside(V position, int step) const {
    const VI index = hn::ConvertTo(di_, position) + hn::Set(di_, step);
    return hn::Min(hn::Max(index, hn::Zero(di_)), hn::Set(di_, size_ - 1));
  }
  HWY_INLINE Quad<V> two_texels(VI row, VI left, VI right) const {
    const LaneIndices<D> first(row + hn::ShiftLeft<1>(left)), second(row + hn::ShiftLeft<1>(right));
    return two_and_two_words(
        d_, [&](std::size_t lane) { return texels_ + first.of[lane]; },
        [&](std::size_t lane) { return texels_ + second.of[lane]; });
  }

  const D d_{};
  const DI di_{};
  const float* texels_;
  int pitch_;
  int size_;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE SurfaceMaterial<V> make_material(D d, const Triple<V>& base_color, V metallic,
                                            V roughness, const Triple<V>& normal,
                                            const Triple<V>& geometric, const Triple<V>& eye,
                                            const SquareTable<D>& split_sum) {
  const V one = hn::Set(d, 1.0f);
  const V plain_f0 = hn::Set(d, dielectric_f0);
  SurfaceMaterial<V> m;
  m.normal = normal;
  m.geometric = geometric;
  m.eye = eye;
  m.n_dot_v = clamped(dot(normal, eye), 1e-3f, 1.0f);
  m.roughness = roughness;
  const Pair<V> split = split_sum.at(m.n_dot_v, roughness);
  const V whole = split.x + split.y;
  const V energy_compensation = one / hn::Max(whole, hn::Set(d, 1e-3f)) - one;
  const V dielectric_scale = hn::MulAdd(plain_f0, energy_compensation, one);
  const V dielectric = (one - metallic) * dielectric_scale;
  const V albedo = hn::MulAdd(plain_f0, split.x, split.y) * dielectric_scale;
  const V diffuse = (one - metallic) * (one - hn::Min(albedo, one));
  const auto channel = [&](V color, V& f0, V& f90_minus_f0, V& specular) HWY_ATTR {
    const V metal = metallic * hn::MulAdd(color, energy_compensation, one);
    f0 = hn::MulAdd(dielectric, plain_f0, metal * color);
    f90_minus_f0 = hn::MulAdd(dielectric, one - plain_f0, metal * (one - color));
    specular = hn::MulAdd(f0, whole, f90_minus_f0 * split.y);
  };
  channel(base_color.x, m.f0.x, m.f90_minus_f0.x, m.specular_albedo.x);
  channel(base_color.y, m.f0.y, m.f90_minus_f0.y, m.specular_albedo.y);
  channel(base_color.z, m.f0.z, m.f90_minus_f0.z, m.specular_albedo.z);
  m.diffuse_albedo = base_color * diffuse;
  return m;
}

/// BRDF x cosine for light arriving along -l.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Triple<V> shade_light(D d, const SurfaceMaterial<V>& m, const Triple<V>& l) {
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const V n_dot_l = hn::Max(dot(m.normal, l), zero);
  const Triple<V> h = normalized(l + m.eye);
  const V alpha = hn::Max(m.roughness * m.roughness, hn::Set(d, 2e-3f));
  const V a2 = alpha * alpha;
  const V n_dot_h = clamped(dot(m.normal, h), 0.0f, 1.0f);
  const V narrow = hn::MulAdd(one - n_dot_h, one + n_dot_h, n_dot_h * n_dot_h * a2);
  const V rest = one - a2;
  const V by_light = n_dot_l * hn::Sqrt(hn::MulAdd(m.n_dot_v * m.n_dot_v, rest, a2));
  const V by_eye = m.n_dot_v * hn::Sqrt(hn::MulAdd(n_dot_l * n_dot_l, rest, a2));
  const V masked = hn::Max(by_light + by_eye, hn::Set(d, 1e-7f));
  constexpr float pi = std::numbers::pi_v<float>;
  const V lobe = hn::Set(d, 0.5f) * a2 * n_dot_l / (hn::Set(d, pi) * narrow * narrow * masked);
  const V x = clamped(one - dot(m.eye, h), 0.0f, 1.0f);
  const V x2 = x * x;
  const V schlick = x2 * x2 * x;
  const V spread = n_dot_l * hn::Set(d, 1.0f / pi);
  const auto channel = [&](V f0, V f90_minus_f0, V diffuse) HWY_ATTR {
    return hn::MulAdd(hn::MulAdd(f90_minus_f0, schlick, f0), lobe, diffuse * spread);
  };
  return {channel(m.f0.x, m.f90_minus_f0.x, m.diffuse_albedo.x),
          channel(m.f0.y, m.f90_minus_f0.y, m.diffuse_albedo.y),
          channel(m.f0.z, m.f90_minus_f0.z, m.diffuse_albedo.z)};
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

/// Lanes that any of the light may reach, of those that `wanted` names.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> reached(D d, const shared::Light& light, const Triple<V>& position,
                               hn::Mask<D> requested) {
  if (light.type == shared::light_directional || light.range <= 0.0f) return requested;
  const Triple<V> to_light = splat(d, light.position) - position;
  return hn::And(requested, hn::Lt(dot(to_light, to_light), hn::Set(d, light.range * light.range)));
}

/// Light that surfaces send to the eye from this punctual light, unshadowed: radiance, 0 in lanes
/// that are not `wanted`. @return whether there is any
template <class D, class V = hn::Vec<D>>
HWY_INLINE bool light_contribution(D d, const shared::Light& light, const SurfaceMaterial<V>& m,
                                   const Triple<V>& position, hn::Mask<D> requested,
                                   Triple<V>& radiance) {
  const auto near = reached(d, light, position, requested);
  if (hn::AllFalse(d, near)) return false;
  const LightSample<V> s = light_at(d, light, position);
  const V zero = hn::Zero(d);
  const auto lit = hn::And(near, hn::Gt(dot(m.geometric, s.direction), zero));
  if (hn::AllFalse(d, lit)) return false;
  const Triple<V> shaded = shade_light(d, m, s.direction);
  const Triple<V> color = splat(d, light.color) * s.attenuation;
  radiance = {hn::IfThenElseZero(lit, color.x * shaded.x),
              hn::IfThenElseZero(lit, color.y * shaded.y),
              hn::IfThenElseZero(lit, color.z * shaded.z)};
  return true;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
