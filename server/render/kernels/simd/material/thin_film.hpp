// Interference in thin films on surfaces: shaders/lib/scene/thin_film.glsl in vectors. Included
// once per instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_THIN_FILM_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_THIN_FILM_HPP
#undef HELIOGRAPH_KERNELS_THIN_FILM_HPP
#else
#define HELIOGRAPH_KERNELS_THIN_FILM_HPP
#endif

#include <numbers>

#include "hwy/contrib/math/math-inl.h"
#include "render/kernels/simd/lanes.hpp"
#include "render/kernels/simd/material/layers.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

struct ThinFilm {
  Float share;      // of the surface that it covers
  Float ior;        // its index of refraction
  Float thickness;  // nanometres
};

/// Reflectance of a boundary at normal incidence.
HWY_INLINE Float boundary_reflectance(Float inside, Float outside) {
  const Float ratio = (inside - outside) / (inside + outside);
  return ratio * ratio;
}

/// The index of refraction that reflects so much at normal incidence to air.
HWY_INLINE Float index_of_reflectance(Float f0) {
  const Float root = hn::Sqrt(clamped(f0, 0.0f, 0.9999f));
  return (one() + root) / (one() - root);
}

/// What red, green and blue see of cos(2 pi path / wavelength + shift); `path` in nanometres.
HWY_INLINE Float3 interference(Float path, const Float3& shift) {
  const Float phase = hn::Min(path, number(1e5f)) * number(2.0f * std::numbers::pi_v<float>);
  const Float squared = phase * phase;
  const auto peak = [&](float weight, float position, float width, Float of) HWY_ATTR {
    return number(weight) * hn::Cos(tag, hn::MulAdd(number(position), phase, of)) *
           hn::Exp(tag, squared * number(-width));
  };
  const Float x = peak(0.84659f, 1.6810e-3f, 4.3278e-9f, shift.x) +
                  peak(0.15387f, 2.2399e-3f, 4.5282e-9f, shift.x);
  const Float y = peak(1.00022f, 1.7953e-3f, 9.3046e-9f, shift.y);
  const Float z = peak(1.00112f, 2.2084e-3f, 6.6121e-9f, shift.z);
  const auto row = [&](float of_x, float of_y, float of_z) HWY_ATTR {
    return hn::MulAdd(number(of_x), x, hn::MulAdd(number(of_y), y, number(of_z) * z));
  };
  return {row(3.2404542f, -1.5371385f, -0.4985314f), row(-0.9692660f, 1.8760108f, 0.0415560f),
          row(0.0556434f, -0.2040259f, 1.0572252f)};
}

/// What film and base of normal reflectance `f0` reflect together at this cosine.
HWY_INLINE Float3 film_reflectance(const ThinFilm& film, Float cosine, const Float3& f0) {
  const Float thick = clamped(film.thickness * number(1.0f / 0.03f), 0.0f, 1.0f);
  const Float smooth = thick * thick * hn::NegMulAdd(number(2.0f), thick, number(3.0f));
  const Float ior = mix(one(), film.ior, smooth);
  const Float within = one() - hn::NegMulAdd(cosine, cosine, one()) / (ior * ior);
  const Float cosine_within = hn::Sqrt(at_least(within, 0.0f));
  const Float first = mix(boundary_reflectance(ior, one()), one(), schlick_weight(cosine));
  const Float passed = one() - first;
  const Float weight_within = schlick_weight(cosine_within);
  Float3 sum, order, root, shift;
  const auto boundary = [&](Float of, Float& sum_of, Float& order_of, Float& root_of,
                            Float& shift_of) HWY_ATTR {
    const Float base_ior = index_of_reflectance(of);
    const Float second = mix(boundary_reflectance(base_ior, ior), one(), weight_within);
    constexpr float pi = std::numbers::pi_v<float>;
    shift_of = select(hn::Lt(base_ior, ior), number(2.0f * pi), number(pi));
    const Float both = clamped(first * second, 1e-5f, 0.9999f);
    const Float returned = passed * passed * second / (one() - both);
    root_of = hn::Sqrt(both);
    sum_of = first + returned;
    order_of = (returned - passed) * root_of;
  };
  boundary(f0.x, sum.x, order.x, root.x, shift.x);
  boundary(f0.y, sum.y, order.y, root.y, shift.y);
  boundary(f0.z, sum.z, order.z, root.z, shift.z);
  const Float twice = number(2.0f), path = twice * ior * film.thickness * cosine_within;
  sum = sum + order * interference(path, shift) * twice;
  order = order * root;
  sum = sum + order * interference(twice * path, shift * twice) * twice;
  return clamped(sum, 0.0f, 1.0f);
}

/// The reflectance at normal incidence that Schlick's approximation makes at `cosine` what the film
/// makes of `f0` there.
HWY_INLINE Float3 filmed_f0(const ThinFilm& film, Float cosine, const Float3& f0) {
  const Float weight = hn::Min(schlick_weight(cosine), number(0.9999f));
  const Float by = one() / (one() - weight);
  const Float3 seen = film_reflectance(film, cosine, f0);
  const auto mixed = [&](Float of, Float before) HWY_ATTR {
    return mix(before, clamped((of - weight) * by, 0.0f, 1.0f), film.share);
  };
  return {mixed(seen.x, f0.x), mixed(seen.y, f0.y), mixed(seen.z, f0.z)};
}

/// The film over points that are seen at `cosine`: over the dielectric, whose reflectance is the
/// layer's, and over the metal, whose reflectance is the base colour.
HWY_NOINLINE inline void add_film(const ThinFilm& film, Float cosine, Float metallic,
                                  SurfaceLayer<Float>& layer, Float3& base_color) {
  const Mask covered = hn::Gt(film.share, zero());
  const Float3 dielectric = layer.f0 * (one() / at_least(layer.f90, 1e-6f));
  layer.f0 = select(covered, filmed_f0(film, cosine, dielectric) * layer.f90, layer.f0);
  const Mask metal = hn::And(covered, hn::Gt(metallic, zero()));
  if (none(metal)) return;
  const Float3 filmed = filmed_f0(film, cosine, base_color);
  base_color = select(metal, mix(base_color, filmed, metallic), base_color);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
