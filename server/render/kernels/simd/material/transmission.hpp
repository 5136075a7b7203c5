// Light that passes surfaces: shaders/lib/lighting/transmission.glsl in vectors. Included once per
// instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_TRANSMISSION_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_TRANSMISSION_HPP
#undef HELIOGRAPH_KERNELS_TRANSMISSION_HPP
#else
#define HELIOGRAPH_KERNELS_TRANSMISSION_HPP
#endif

#include "render/kernels/common/pixel_band.hpp"
#include "render/kernels/simd/material/hit_material.hpp"
#include "render/kernels/simd/material/specular_lobe.hpp"
#include "render/kernels/simd/random.hpp"
#include "shaders/shared/transmission.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Where rays meet the boundaries of volumes.
struct BoundaryLanes {
  Mask volume;     // one lets light in
  Mask leaving;    // and the ray comes from within
  Integer medium;  // number of its layer, 0 elsewhere
};

HWY_INLINE BoundaryLanes no_boundary() {
  const Mask nowhere = hn::FirstN(tag, 0);
  return {nowhere, nowhere, integer(0)};
}

HWY_INLINE Records layer_records(const SceneView& scene, Integer number) {
  return {scene.layers, number, sizeof(Layer) / 4};
}

/// Of the materials of instances.
HWY_INLINE Integer layer_number(const SceneView& scene, Integer instance_number) {
  const Records instance(scene.instances, instance_number, sizeof(shared::Instance) / 4);
  const Records mesh(scene.meshes, instance.whole(HELIOGRAPH_WORD(shared::Instance, mesh)),
                     sizeof(shared::Mesh) / 4);
  const Records material(scene.materials, mesh.whole(HELIOGRAPH_WORD(shared::Mesh, material)),
                         sizeof(Material) / 4);
  return material.whole(HELIOGRAPH_WORD(Material, layer));
}

/// The boundaries at `hit` of rays along `direction`.
HWY_INLINE BoundaryLanes boundary_of(const SceneView&, const HitLanes&, const SurfaceLanes&,
                                     const Float3&) {
  return no_boundary();
}
HWY_INLINE BoundaryLanes boundary_of(const SceneView& scene, const HitLanes& hit,
                                     const LayeredSurfaceLanes& s, const Float3& direction) {
  const Mask transmits = hn::And(hit.met, hn::Gt(s.layer.transmission, zero()));
  if (none(transmits)) return no_boundary();
  const Integer number = layer_number(scene, hit.instance);
  const Float index = layer_records(scene, number).real(HELIOGRAPH_WORD(Layer, refraction));
  const Mask volume = hn::And(transmits, hn::Gt(index, zero()));
  return {volume, hn::And(volume, hn::Gt(dot(s.front, direction), zero())),
          select(volume, number, integer(0))};
}

/// Whether what is behind blended surfaces shows along rays of their own, not straight through.
HWY_INLINE Mask bends_light(const shared::FrameConstants&, const SurfaceLanes&,
                            const BoundaryLanes& boundary) {
  return boundary.volume;
}
HWY_INLINE Mask bends_light(const shared::FrameConstants& frame, const LayeredSurfaceLanes& s,
                            const BoundaryLanes& boundary) {
  if ((frame.flags & shared::frame_refraction) == 0) return hn::FirstN(tag, 0);
  const Mask rough = hn::Ge(s.roughness, number(shared::least_blurring_roughness));
  return hn::Or(boundary.volume, hn::And(rough, hn::Gt(s.layer.transmission, zero())));
}

/// How strongly each medium splits light into its colours: 20 / Abbe number.
HWY_INLINE Float dispersion_of(const SceneView& scene, Integer medium) {
  return layer_records(scene, medium).real(HELIOGRAPH_WORD(Layer, dispersion));
}

/// The bands of wavelengths that pixels' rays have in volumes that split light into its colours.
class PixelBands {
 public:
  explicit PixelBands(const shared::FrameConstants& frame)
      : turn_(static_cast<int>(band_turn(frame))) {}

  HWY_INLINE Integer at(const SceneView& scene, Integer medium, const PixelLanes& pixel) const {
    const Mask splits = hn::Gt(dispersion_of(scene, medium), zero());
    if (none(splits)) return integer(0);
    const Integer sum = hn::Add(hn::Add(pixel.x, pixel.y), integer(turn_));
    // Half a unit from where rounding would decide.
    const Integer whole = truncated((to_float(sum) + number(0.5f)) * number(1.0f / 3.0f));
    const Integer color = hn::Sub(sum, hn::Mul(whole, integer(3)));
    return hn::IfThenElseZero(integer_mask(splits), hn::Add(color, integer(1)));
  }

 private:
  int turn_;
};

/// `band`: 1 red, 2 green, 3 blue, 0 all of them.
HWY_INLINE Float refraction_index(const SceneView& scene, Integer medium, Integer band) {
  const Records layer = layer_records(scene, medium);
  const Float index = layer.real(HELIOGRAPH_WORD(Layer, refraction));
  const Float dispersion = layer.real(HELIOGRAPH_WORD(Layer, dispersion));
  const Float half_range = number(0.025f) * dispersion * (index - one());
  const Float of_band = hn::MulAdd(half_range, to_float(band) - number(2.0f), index);
  return select(float_mask(hn::Eq(band, integer(0))), index, at_least(of_band, 1.0f));
}

HWY_INLINE Float3 left_of(const Float3& exponents) {
  const auto left = [](Float exponent) HWY_ATTR { return hn::Exp(tag, hn::Neg(exponent)); };
  return {left(exponents.x), left(exponents.y), left(exponents.z)};
}

/// Fraction of light that is left after the thickness that each medium's material states, as large
/// as its instance makes it.
HWY_INLINE Float3 left_by_thickness(const SceneView& scene, Integer instance_number,
                                    Integer medium) {
  const Records instance(scene.instances, instance_number, sizeof(shared::Instance) / 4);
  return left_of(layer_records(scene, medium).triple(HELIOGRAPH_WORD(Layer, absorption)) *
                 instance.real(HELIOGRAPH_WORD(shared::Instance, scale)));
}

/// Fraction of light that is left after `distance` metres of each medium.
HWY_INLINE Float3 left_by_volume(const SceneView& scene, Integer medium, Float distance) {
  return left_of(layer_records(scene, medium).triple(HELIOGRAPH_WORD(Layer, attenuation)) *
                 distance);
}

/// `direction`, or where it lies below the plane of `normal`, what is as far above it.
HWY_INLINE Float3 above_plane(const Float3& direction, const Float3& normal) {
  const Float below = hn::Min(dot(direction, normal), zero());
  return direction - normal * (number(2.0f) * below);
}

/// Microfacets' normals as the eye sees them, world space.
HWY_INLINE Float3 sample_microfacet(const MaterialLanes& m, const Float2& u) {
  Float3 tangent, bitangent;
  orthonormal_basis(m.normal, tangent, bitangent);
  const Float3 view = normalized(
      Float3{dot(m.eye, tangent), dot(m.eye, bitangent), at_least(dot(m.eye, m.normal), 1e-3f)});
  const Float3 h = sample_visible_normal(view, m.roughness * m.roughness, u);
  return normalized(multiply_add(tangent, h.x, multiply_add(bitangent, h.y, m.normal * h.z)));
}

/// `incident` refracted at a boundary whose `normal` faces it; `ratio`: of the indices of
/// refraction before and behind it. Where all is reflected: along the boundary.
HWY_INLINE Float3 refracted(const Float3& incident, const Float3& normal, Float ratio) {
  const Float cosine = hn::Neg(dot(incident, normal));
  const Float behind2 = hn::NegMulAdd(ratio * ratio, hn::NegMulAdd(cosine, cosine, one()), one());
  const Float along = hn::MulSub(ratio, cosine, hn::Sqrt(at_least(behind2, 0.0f)));
  return normalized(incident * ratio + normal * along);
}

/// The directions in which the eye's rays go on behind surfaces. `index`: of the volumes that they
/// enter; 0: thin walls.
HWY_INLINE Float3 sample_transmitted(const MaterialLanes& m, Float index, const Float2& u) {
  const Float3 h = sample_microfacet(m, u);
  const Mask thin = hn::Le(index, zero());
  const Float3 straight = normalized(reflect(reflect(-m.eye, h), m.normal));
  if (all(thin)) return above_plane(straight, -m.geometric);
  const Mask turned = hn::Lt(dot(m.eye, h), zero());
  const Float3 bent = refracted(-m.eye, select(turned, -h, h), one() / select(thin, one(), index));
  return above_plane(select(thin, straight, bent), -m.geometric);
}

/// Where paths from within volumes go at their boundaries.
struct DepartureLanes {
  Float3 direction;
  Float3 weight;
  Mask outside;
  Mask diffuse;
};

HWY_INLINE DepartureLanes sample_departure(const LayeredSurfaceLanes& s, const MaterialLanes& m,
                                           Float index, Float pick, const Float2& u) {
  const Float3 h = sample_microfacet(m, u);
  const Float v_dot_h = at_least(dot(m.eye, h), 0.0f);
  const Float outside2 =
      hn::NegMulAdd(index * index, hn::NegMulAdd(v_dot_h, v_dot_h, one()), one());
  const Float schlick = schlick_weight(hn::Sqrt(at_least(outside2, 0.0f)));
  const Mask total = hn::Le(outside2, zero());
  const auto reflectance = [&](Float f0) HWY_ATTR {
    return select(total, one(), hn::MulAdd(s.layer.f90 - f0, schlick, f0));
  };
  const Float3 dielectric{reflectance(s.layer.f0.x), reflectance(s.layer.f0.y),
                          reflectance(s.layer.f0.z)};
  const Float clear = (one() - s.metallic) * s.layer.transmission;
  const Float entering = one() - hn::Min(largest_of(dielectric), one());
  const Float3 reflected = dielectric * clear + s.base_color * s.metallic;
  const Float3 transmitted = s.base_color * (clear * entering);
  const Float3 scattered = s.base_color * (one() - s.metallic - clear);
  const Float reflects = luminance(reflected), transmits = luminance(transmitted);
  const Float scatters = luminance(scattered);
  const Float sum = at_least(reflects + transmits + scatters, 1e-6f);
  const Float at = pick * sum;
  DepartureLanes d;
  const Mask mirrored = hn::Lt(at, reflects);
  d.diffuse = hn::Ge(at, reflects + transmits);
  d.outside = hn::Not(hn::Or(mirrored, d.diffuse));
  const auto share = [&](const Float3& of, Float probability)
                         HWY_ATTR { return of * (sum / at_least(probability, 1e-6f)); };
  d.weight = select(d.outside, share(transmitted, transmits),
                    select(d.diffuse, share(scattered, scatters), share(reflected, reflects)));
  d.direction = select(d.outside, refracted(-m.eye, h, index),
                       select(d.diffuse, sample_cosine(m.normal, u.x, u.y), reflect(-m.eye, h)));
  d.direction = above_plane(d.direction, select(d.outside, -m.geometric, m.geometric));
  return d;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
