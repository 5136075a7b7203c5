// What rays have met, as shaders/lib/scene/hit_surface.glsl has it, a lane for every ray. Included
// once per instruction set.
#if defined(HELIOGRAPH_KERNELS_SURFACE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_SURFACE_HPP
#undef HELIOGRAPH_KERNELS_SURFACE_HPP
#else
#define HELIOGRAPH_KERNELS_SURFACE_HPP
#endif

#include "render/kernels/simd/material/hit_triangles.hpp"
#include "render/kernels/simd/material/layers.hpp"
#include "render/kernels/simd/material/slots.hpp"
#include "render/kernels/simd/material/thin_film.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// shaders/lib/math/octahedral.glsl
HWY_INLINE Float2 octahedral_encode(const Float3& v) {
  const Float by = one() / (hn::Abs(v.x) + hn::Abs(v.y) + hn::Abs(v.z));
  const Float x = v.x * by, y = v.y * by;
  const Mask above = hn::Ge(v.z, zero());
  const auto folded = [](Float side, Float across) {
    const Float size = one() - hn::Abs(across);
    return select(hn::Ge(side, zero()), size, hn::Neg(size));
  };
  return {select(above, x, folded(x, y)), select(above, y, folded(y, x))};
}

struct SurfaceLanes {
  static constexpr bool layered = false;
  Float3 position;   // world
  Float3 normal;     // shading, turned to the side that the ray came from
  Float3 geometric;  // of the triangle, likewise
  Float3 front;      // of the triangle's front face, by its winding
  Float3 local;      // position, mesh space
  Float area;        // of the triangle, world, square metres
  Float3 base_color;
  Float3 emissive;  // linear radiance
  Float alpha, alpha_cutoff, metallic, roughness, occlusion;
  Integer flags;  // material_*
  Mask has(std::uint32_t flag) const {
    const Integer requested = integer(static_cast<int>(flag));
    return float_mask(hn::Eq(hn::And(flags, requested), requested));
  }
};

/// In scenes whose materials have layers.
struct LayeredSurfaceLanes : SurfaceLanes {
  static constexpr bool layered = true;
  SurfaceLayer<Float> layer;
  Float passing;  // fraction of rays that tracers let pass where it covers
};

/// One uv set of the corners. `footprint` is log2 of the squared fraction of the triangle that the
/// ray's cone covers.
HWY_INLINE void read_uv(const TriangleLanes& t, const Float2& a, const Float2& b, const Float2& c,
                        Float footprint, Float2& uv, Float& lod) {
  uv = {t.between(a.x, b.x, c.x), t.between(a.y, b.y, c.y)};
  const Float area = hn::Abs(hn::MulSub(hn::Sub(b.x, a.x), hn::Sub(c.y, a.y),
                                        hn::Mul(hn::Sub(b.y, a.y), hn::Sub(c.x, a.x))));
  lod = hn::MulAdd(hn::Log2(tag, at_least(area, 1e-30f)), number(0.5f), footprint);
}

/// The normal map in `slot` about the front face's `normal`; its scale is the word `scale_word`.
template <class Slots>
HWY_INLINE Float3 mapped_normal(Slots& slots, int slot, const Records& record, int scale_word,
                                const TriangleLanes& triangle, const MatrixLanes& world,
                                Float handedness, const Float3& normal) {
  Mask mapped = slots.used(slot);
  if (none(mapped)) return normal;
  const Float4 texel = slots.texel(slot);
  const Float scale = record.real(scale_word);
  const Float2 slope{hn::Mul(hn::MulSub(texel.x, number(2.0f), one()), scale),
                     hn::Mul(hn::MulSub(texel.y, number(2.0f), one()), scale)};
  const Float height = hn::MulSub(texel.z, number(2.0f), one());
  Float3 tangent, bitangent;
  mapped = hn::And(mapped, tangent_plane(triangle, world, handedness, normal, tangent, bitangent));
  const Float3 turned =
      normalized(multiply_add(tangent, slope.x, multiply_add(bitangent, slope.y, normal * height)));
  return select(mapped, turned, normal);
}

template <bool one_level>
HWY_INLINE void evaluate_material(MaterialSlots<one_level>& slots, const Float4& base,
                                  const TriangleLanes& triangle, const Records& material,
                                  SurfaceLanes& s) {
  const Float4 &a = triangle.a().color, &b = triangle.b().color, &c = triangle.c().color;
  const Float4 factor = material.four(HELIOGRAPH_WORD(Material, base_color));
  const Float3 color{hn::Mul(hn::Mul(base.x, factor.x), triangle.between(a.x, b.x, c.x)),
                     hn::Mul(hn::Mul(base.y, factor.y), triangle.between(a.y, b.y, c.y)),
                     hn::Mul(hn::Mul(base.z, factor.z), triangle.between(a.z, b.z, c.z))};
  s.alpha = hn::Mul(hn::Mul(base.w, factor.w), triangle.between(a.w, b.w, c.w));
  s.base_color = clamped(color, 0.0f, 1.0f);

  const Float4 packed = slots.texel(HELIOGRAPH_WORD(Material, metallic_roughness_slot));
  static_assert(offsetof(Material, roughness) == offsetof(Material, metallic) + 4 &&
                offsetof(Material, occlusion_strength) == offsetof(Material, metallic) + 12);
  const Float4 factors = material.four(HELIOGRAPH_WORD(Material, metallic));
  s.metallic = clamped(hn::Mul(factors.x, packed.z), 0.0f, 1.0f);
  s.roughness = clamped(hn::Mul(factors.y, packed.y), 0.0f, 1.0f);
  constexpr int occlusion_slot = HELIOGRAPH_WORD(Material, occlusion_slot);
  Float occlusion = slots.texel(occlusion_slot, slot_repeats).x;
  const Integer repeats = hn::And(material.whole(occlusion_slot + HELIOGRAPH_WORD(Slot, flags)),
                                  integer(static_cast<int>(slot_repeats)));
  occlusion = select(float_mask(hn::Ne(repeats, integer(0))), packed.x, occlusion);
  s.occlusion = mix(one(), occlusion, factors.w);
  const Float4 glow = slots.texel(HELIOGRAPH_WORD(Material, emissive_slot));
  static_assert(offsetof(Material, alpha_cutoff) == offsetof(Material, emissive) + 12);
  const Float4 emissive = material.four(HELIOGRAPH_WORD(Material, emissive));
  s.emissive = Float3{emissive.x, emissive.y, emissive.z} * Float3{glow.x, glow.y, glow.z};
  s.alpha_cutoff = emissive.w;
  s.flags = material.whole(HELIOGRAPH_WORD(Material, flags));
}

HWY_INLINE LookupLanes texture_lookup(const TriangleLanes& triangle, const Records& material,
                                      Float twice_world_area, Float width, Float cosine) {
  LookupLanes lookup;
  lookup.first = lookup.second = {zero(), zero()};
  lookup.first_lod = lookup.second_lod = zero();
  const Integer uses = material.whole(HELIOGRAPH_WORD(Material, uses));
  if (hn::AllTrue(integer_tag, hn::Eq(uses, integer(0)))) return lookup;
  const Float across = hn::Div(at_least(width, 1e-20f), at_least(cosine, 1e-2f));
  const Float footprint = hn::NegMulAdd(
      number(0.5f), hn::Log2(tag, at_least(twice_world_area, 1e-30f)), hn::Log2(tag, across));
  const Float4 &a = triangle.a().uv, &b = triangle.b().uv, &c = triangle.c().uv;
  read_uv(triangle, {a.x, a.y}, {b.x, b.y}, {c.x, c.y}, footprint, lookup.first, lookup.first_lod);
  const Integer second = integer(static_cast<int>(uses_second_uv));
  if (!hn::AllFalse(integer_tag, hn::Eq(hn::And(uses, second), second))) {
    read_uv(triangle, {a.z, a.w}, {b.z, b.w}, {c.z, c.w}, footprint, lookup.second,
            lookup.second_lod);
  }
  return lookup;
}

/// What extensions add, with the textures of `slots`. `scale`: of the instances. Not inlined: in
/// most scenes with layers few surfaces have any.
template <bool one_level>
HWY_NOINLINE void evaluate_layer(LayerSlots<one_level>& slots, const Records& from,
                                 const Float3& coat_normal, Float scale,
                                 SurfaceLayer<Float>& layer) {
  static_assert(offsetof(Layer, specular) == 12 && offsetof(Layer, sheen_roughness) == 28 &&
                offsetof(Layer, transmission) == 44 && offsetof(Layer, dielectric) == 48 &&
                offsetof(Layer, coat_roughness) == 56);
  const Float4 coats = from.four(HELIOGRAPH_WORD(Layer, dielectric));
  layer.coat = coats.y * slots.texel(HELIOGRAPH_WORD(Layer, coat_slot)).x;
  layer.coat_roughness = coats.z * slots.texel(HELIOGRAPH_WORD(Layer, coat_roughness_slot)).y;
  layer.coat_normal = coat_normal;
  const Float4 specular = from.four(HELIOGRAPH_WORD(Layer, specular_color));
  const Float4 tint = slots.texel(HELIOGRAPH_WORD(Layer, specular_color_slot));
  layer.f90 = specular.w * slots.texel(HELIOGRAPH_WORD(Layer, specular_slot)).w;
  const auto reflectance = [&](Float color, Float texel) HWY_ATTR {
    return layer.f90 * hn::Min(coats.x * color * texel, one());
  };
  layer.f0 = {reflectance(specular.x, tint.x), reflectance(specular.y, tint.y),
              reflectance(specular.z, tint.z)};
  const Float4 sheen = from.four(HELIOGRAPH_WORD(Layer, sheen));
  const Float4 fuzz = slots.texel(HELIOGRAPH_WORD(Layer, sheen_color_slot));
  layer.sheen = Float3{sheen.x, sheen.y, sheen.z} * Float3{fuzz.x, fuzz.y, fuzz.z};
  layer.sheen_roughness = sheen.w * slots.texel(HELIOGRAPH_WORD(Layer, sheen_roughness_slot)).w;
  const Float4 absorption = from.four(HELIOGRAPH_WORD(Layer, absorption));
  layer.transmission = absorption.w * slots.texel(HELIOGRAPH_WORD(Layer, transmission_slot)).x;
  layer.transmitted = numbers(0.0f);
  if (none(hn::Gt(layer.transmission, zero()))) return;
  const Float thickness = slots.texel(HELIOGRAPH_WORD(Layer, thickness_slot)).y * scale;
  const auto remaining = [&](Float exponent) HWY_ATTR {
    return layer.transmission * hn::Exp(tag, hn::Neg(exponent * thickness));
  };
  layer.transmitted = {remaining(absorption.x), remaining(absorption.y), remaining(absorption.z)};
}

/// The grain of surfaces, at the front face's normal.
template <bool one_level>
HWY_NOINLINE void add_grain(LayerSlots<one_level>& slots, const Records& from,
                            const HitRecords& records, const Float3& vertex_normal,
                            SurfaceLayer<Float>& layer) {
  static_assert(offsetof(Layer, grain_y) == offsetof(Layer, anisotropy) + 8);
  layer.grain = {one(), zero(), zero()};
  const Float4 factors = from.four(HELIOGRAPH_WORD(Layer, anisotropy));
  layer.anisotropy = factors.x;
  if (none(hn::Gt(factors.x, zero()))) return;
  constexpr int slot = HELIOGRAPH_WORD(Layer, anisotropy_slot);
  const Mask mapped = slots.used(slot);
  const Float4 texel = slots.texel(slot);
  const Float x = select(mapped, hn::MulSub(texel.x, number(2.0f), one()), one());
  const Float y = hn::IfThenElseZero(mapped, hn::MulSub(texel.y, number(2.0f), one()));
  Float3 tangent, bitangent;
  const Mask has_tangent = tangent_plane(records.triangle, records.world, records.handedness,
                                         vertex_normal, tangent, bitangent);
  const Float3 grain = tangent * hn::MulSub(factors.y, x, factors.z * y) +
                       bitangent * hn::MulAdd(factors.z, x, factors.y * y);
  const Float size = dot(grain, grain);
  layer.grain = grain * hn::Div(one(), hn::Sqrt(at_least(size, 1e-12f)));
  layer.anisotropy =
      hn::IfThenElseZero(hn::And(has_tangent, hn::Gt(size, number(1e-6f))), factors.x * texel.z);
}

/// What of the diffuse light of surfaces leaves at their other side.
template <bool one_level>
HWY_NOINLINE void add_diffuse_transmission(LayerSlots<one_level>& slots, const Records& from,
                                           Float scale, SurfaceLayer<Float>& layer) {
  static_assert(offsetof(Layer, diffuse_transmission) == offsetof(Layer, diffuse_tint) + 12);
  layer.diffuse_transmission = zero();
  layer.diffuse_tint = numbers(0.0f);
  const Float4 factors = from.four(HELIOGRAPH_WORD(Layer, diffuse_tint));
  if (none(hn::Gt(factors.w, zero()))) return;
  const Float texel = slots.texel(HELIOGRAPH_WORD(Layer, diffuse_transmission_slot)).w;
  layer.diffuse_transmission = factors.w * texel;
  const Float4 tint = slots.texel(HELIOGRAPH_WORD(Layer, diffuse_tint_slot));
  const Float3 absorption = from.triple(HELIOGRAPH_WORD(Layer, absorption));
  const Float thickness = slots.texel(HELIOGRAPH_WORD(Layer, thickness_slot)).y * scale;
  const auto left = [&](Float factor, Float color, Float exponent) HWY_ATTR {
    return factor * color * hn::Exp(tag, hn::Neg(exponent * thickness));
  };
  layer.diffuse_tint = {left(factors.x, tint.x, absorption.x),
                        left(factors.y, tint.y, absorption.y),
                        left(factors.z, tint.z, absorption.z)};
}

/// The film on surfaces, whose normal and metalness are known.
template <bool one_level>
HWY_INLINE void add_film(LayerSlots<one_level>& slots, const Records& from, const Float3& direction,
                         LayeredSurfaceLanes& s) {
  static_assert(offsetof(Layer, film_thickness) == offsetof(Layer, iridescence) + 12);
  const Float4 factors = from.four(HELIOGRAPH_WORD(Layer, iridescence));
  if (none(hn::Gt(factors.x, zero()))) return;
  ThinFilm film;
  film.share = factors.x * slots.texel(HELIOGRAPH_WORD(Layer, iridescence_slot)).x;
  film.ior = factors.y;
  film.thickness = mix(factors.z, factors.w, slots.texel(HELIOGRAPH_WORD(Layer, film_slot)).y);
  film.share = hn::IfThenElseZero(hn::Gt(film.thickness, zero()), film.share);
  const Float cosine = clamped(hn::Neg(dot(s.normal, direction)), 1e-3f, 1.0f);
  add_film(film, cosine, s.metallic, s.layer, s.base_color);
}

/// The layers of `s`, at the front face's normal.
template <bool one_level>
HWY_INLINE void add_layer(const SceneView& scene, const HitRecords& records,
                          const LookupLanes& lookup, const Float3& direction,
                          const Float3& vertex_normal, Float side, LayeredSurfaceLanes& s) {
  const Integer number = records.material.whole(HELIOGRAPH_WORD(Material, layer));
  const Records from(scene.layers, number, sizeof(Layer) / 4);
  LayerSlots<one_level> slots(scene, from, lookup);
  const Float3 coat_normal =
      mapped_normal(slots, HELIOGRAPH_WORD(Layer, coat_normal_slot), from,
                    HELIOGRAPH_WORD(Layer, coat_normal_scale), records.triangle, records.world,
                    records.handedness, vertex_normal);
  const Mask plain = float_mask(hn::Eq(number, integer(0)));
  evaluate_layer<one_level>(slots, from,
                            select(plain, numbers(glm::vec3(0.0f, 0.0f, 1.0f)), coat_normal) * side,
                            records.scale, s.layer);
  add_grain<one_level>(slots, from, records, vertex_normal, s.layer);
  add_diffuse_transmission<one_level>(slots, from, records.scale, s.layer);
  add_film<one_level>(slots, from, direction, s);
  s.passing = records.material.real(HELIOGRAPH_WORD(Material, passing));
  s.alpha = select(s.has(shared::material_whole_alpha), one(), s.alpha);
}

/// Where a point of `records.triangle` that set_point() names is met by rays along `direction`,
/// whose footprints there are `width` metres.
template <class Surface, bool one_level>
HWY_INLINE Surface surface_at(const SceneView& scene, const HitRecords& records,
                              const Float3& direction, Float width) {
  const TriangleLanes& triangle = records.triangle;
  const MatrixLanes& world = records.world;
  const Float handedness = records.handedness;
  const Records& material = records.material;
  Surface s;
  const Float3 &a = triangle.a().position, &b = triangle.b().position;
  const Float3& c = triangle.c().position;
  s.local = triangle.position();
  s.position = world.point(s.local);
  // Cofactors of the matrix, as in gbuffer.vert.
  const Float3 by_x = cross(world.y, world.z) * handedness,
               by_y = cross(world.z, world.x) * handedness;
  const Float3 by_z = cross(world.x, world.y) * handedness;
  const auto turned = [&](const VertexLanes& vertex) {
    const Float3& n = vertex.normal;
    return normalized(multiply_add(by_x, n.x, multiply_add(by_y, n.y, by_z * n.z)));
  };
  const Float3 vertex_normal = normalized(
      triangle.between(turned(triangle.a()), turned(triangle.b()), turned(triangle.c())));
  const Float3 across = cross(world.direction(b - a), world.direction(c - a)) * handedness;
  const Float area = hn::Sqrt(dot(across, across));
  s.area = area * number(0.5f);
  const Mask flat = hn::Le(area, zero());
  s.front = select(flat, vertex_normal, across * hn::Div(one(), select(flat, one(), area)));
  const Float cosine = dot(s.front, direction);
  const Float side = select(hn::Le(cosine, zero()), one(), number(-1.0f));
  // Like the G-buffer: where winding and normals disagree, the normals say which side this is.
  const Mask opposed = hn::Lt(dot(s.front, vertex_normal), zero());
  s.geometric = s.front * select(opposed, hn::Neg(side), side);
  const LookupLanes lookup = texture_lookup(triangle, material, area, width, hn::Abs(cosine));
  MaterialSlots<one_level> slots(scene, material, lookup);
  const Float4 base = slots.texel(HELIOGRAPH_WORD(Material, base_color_slot));
  s.normal = mapped_normal(slots, HELIOGRAPH_WORD(Material, normal_slot), material,
                           HELIOGRAPH_WORD(Material, normal_scale), triangle, world, handedness,
                           vertex_normal) *
             side;
  evaluate_material<one_level>(slots, base, triangle, material, s);
  if constexpr (Surface::layered) {
    add_layer<one_level>(scene, records, lookup, direction, vertex_normal, side, s);
  }
  return s;
}

/// `hit` of rays along `direction` whose footprints at the hits are `width` metres.
template <class Surface, bool one_level>
HWY_INLINE Surface hit_surface(const SceneView& scene, const HitLanes& hit, const Float3& direction,
                               Float width) {
  HitRecords records(scene, hit);
  records.triangle.set_point(hit.u, hit.v);
  return surface_at<Surface, one_level>(scene, records, direction, width);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
