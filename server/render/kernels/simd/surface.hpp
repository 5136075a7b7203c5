// What rays have met, as shaders/lib/scene/hit_surface.glsl has it, a lane for every ray. Included
// once per instruction set.
#if defined(HELIOGRAPH_KERNELS_SURFACE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_SURFACE_HPP
#undef HELIOGRAPH_KERNELS_SURFACE_HPP
#else
#define HELIOGRAPH_KERNELS_SURFACE_HPP
#endif

#include "render/kernels/simd/lanes.hpp"
#include "render/kernels/simd/textures.hpp"
#include "shaders/shared/ray.h"

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

struct HitLanes {
  Mask met;
  Float t, u, v;
  Integer instance, triangle;  // of lanes that met nothing: another lane's
};

/// `index` counts hits; lanes without `wanted` count as misses.
HWY_INLINE HitLanes load_hits(const shared::Hit* hits, Integer index, Mask requested) {
  const Integer word = hn::Mul(index, integer(sizeof(shared::Hit) / 4));
  const auto at = [&](std::size_t offset) {
    return hn::Add(word, integer(static_cast<int>(offset / 4)));
  };
  HitLanes h;
  h.instance = gather(hits, at(offsetof(shared::Hit, instance)));
  const auto none_met = integer(static_cast<int>(shared::hit_none));
  h.met = hn::AndNot(float_mask(hn::Eq(h.instance, none_met)), requested);
  if (none(h.met)) return h;
  h.t = as_float(gather(hits, at(offsetof(shared::Hit, t))));
  h.u = as_float(gather(hits, at(offsetof(shared::Hit, u))));
  h.v = as_float(gather(hits, at(offsetof(shared::Hit, v))));
  h.triangle = gather(hits, at(offsetof(shared::Hit, triangle)));
  const auto first = static_cast<std::size_t>(hn::FindFirstTrue(tag, h.met));
  h.instance = select(h.met, h.instance, integer(hn::ExtractLane(h.instance, first)));
  h.triangle = select(h.met, h.triangle, integer(hn::ExtractLane(h.triangle, first)));
  h.t = select(h.met, h.t, one());
  h.u = hn::IfThenElseZero(h.met, h.u);
  h.v = hn::IfThenElseZero(h.met, h.v);
  return h;
}

struct SurfaceLanes {
  Float3 position;   // world
  Float3 normal;     // shading, turned to the side that the ray came from
  Float3 geometric;  // of the triangle, likewise
  Float3 front;      // of the triangle's front face, by its winding
  Float3 local;      // position, mesh space
  Float3 base_color;
  Float3 emissive;  // linear radiance
  Float alpha, alpha_cutoff, metallic, roughness, occlusion;
  Integer flags;  // material_*
  Mask has(std::uint32_t flag) const {
    const Integer requested = integer(static_cast<int>(flag));
    return float_mask(hn::Eq(hn::And(flags, requested), requested));
  }
};

/// The columns of an affine matrix.
struct MatrixLanes {
  Float3 x, y, z, origin;
  HWY_INLINE MatrixLanes(const Records& instance, int word)
      : x(instance.triple(word)),
        y(instance.triple(word + 4)),
        z(instance.triple(word + 8)),
        origin(instance.triple(word + 12)) {}
  HWY_INLINE Float3 direction(const Float3& v) const {
    return multiply_add(x, v.x, multiply_add(y, v.y, z * v.z));
  }
  HWY_INLINE Float3 point(const Float3& v) const {
    return multiply_add(x, v.x, multiply_add(y, v.y, multiply_add(z, v.z, origin)));
  }
};

/// The corners of each lane's triangle and their weights. Lanes that are not `wanted` have the
/// first vertex three times.
class TriangleLanes {
 public:
  HWY_INLINE TriangleLanes(const shared::Vertex* vertices, const std::uint32_t* indices,
                           Integer first_index, Integer first_vertex, const HitLanes& hit,
                           Mask requested)
      : a_(corner(vertices, indices, first_index, first_vertex, 0, requested)),
        b_(corner(vertices, indices, first_index, first_vertex, 1, requested)),
        c_(corner(vertices, indices, first_index, first_vertex, 2, requested)),
        weight_a_(hn::Sub(hn::Sub(one(), hit.u), hit.v)),
        weight_b_(hit.u),
        weight_c_(hit.v) {}

  HWY_INLINE Float between(Float a, Float b, Float c) const {
    return hn::MulAdd(a, weight_a_, hn::MulAdd(b, weight_b_, hn::Mul(c, weight_c_)));
  }
  HWY_INLINE Float3 between(const Float3& a, const Float3& b, const Float3& c) const {
    return multiply_add(a, weight_a_, multiply_add(b, weight_b_, c * weight_c_));
  }
  HWY_INLINE Float3 between(int word) const {
    return between(a_.triple(word), b_.triple(word), c_.triple(word));
  }
  HWY_INLINE const Records& a() const { return a_; }
  HWY_INLINE const Records& b() const { return b_; }
  HWY_INLINE const Records& c() const { return c_; }

 private:
  static HWY_INLINE Records corner(const shared::Vertex* vertices, const std::uint32_t* indices,
                                   Integer first_index, Integer first_vertex, int number,
                                   Mask requested) {
    const Integer index = hn::IfThenElseZero(
        integer_mask(requested), gather(indices, hn::Add(first_index, integer(number))));
    return Records(vertices, hn::Add(first_vertex, index), sizeof(shared::Vertex) / 4);
  }
  Records a_, b_, c_;
  Float weight_a_, weight_b_, weight_c_;
};

/// Where textures are read: both uv sets, and the level of detail of an image of one texel.
struct LookupLanes {
  Float2 first, second;
  Float first_lod, second_lod;
};

/// One uv set. `footprint` is log2 of the squared fraction of the triangle that the ray's cone
/// covers.
HWY_INLINE void read_uv(const TriangleLanes& t, int word, Float footprint, Float2& uv, Float& lod) {
  const Float ax = t.a().real(word), ay = t.a().real(word + 1);
  const Float bx = t.b().real(word), by = t.b().real(word + 1);
  const Float cx = t.c().real(word), cy = t.c().real(word + 1);
  uv = {t.between(ax, bx, cx), t.between(ay, by, cy)};
  const Float area = hn::Abs(
      hn::MulSub(hn::Sub(bx, ax), hn::Sub(cy, ay), hn::Mul(hn::Sub(by, ay), hn::Sub(cx, ax))));
  lod = hn::MulAdd(hn::Log2(tag, at_least(area, 1e-30f)), number(0.5f), footprint);
}

/// The slot of each lane's material that begins at `word`; white where there is no texture.
template <bool one_level>
HWY_INLINE Float4 slot_texel(const SceneView& scene, const Records& material, int word,
                             const LookupLanes& lookup, std::uint32_t unless = 0) {
  const auto whole = [&](int member) { return material.whole(word + member); };
  TextureLanes t;
  t.flags = whole(HELIOGRAPH_WORD(Slot, flags));
  t.used = float_mask(hn::Eq(hn::And(t.flags, integer(static_cast<int>(slot_used | unless))),
                             integer(static_cast<int>(slot_used))));
  const Float4 white{one(), one(), one(), one()};
  if (none(t.used)) return white;
  t.width = whole(HELIOGRAPH_WORD(Slot, width));
  t.height = whole(HELIOGRAPH_WORD(Slot, height));
  t.levels = whole(HELIOGRAPH_WORD(Slot, levels));
  t.wrap_s = whole(HELIOGRAPH_WORD(Slot, wrap_s));
  t.wrap_t = whole(HELIOGRAPH_WORD(Slot, wrap_t));
  t.first_level = whole(HELIOGRAPH_WORD(Slot, first_level));
  const Mask first = float_mask(hn::Eq(whole(HELIOGRAPH_WORD(Slot, uv_set)), integer(0)));
  const Float x = select(first, lookup.first.x, lookup.second.x);
  const Float y = select(first, lookup.first.y, lookup.second.y);
  const auto row = [&](int at) {
    return hn::MulAdd(material.real(word + at), x,
                      hn::MulAdd(material.real(word + at + 1), y, material.real(word + at + 2)));
  };
  const Float2 uv{row(HELIOGRAPH_WORD(Slot, row0)), row(HELIOGRAPH_WORD(Slot, row1))};
  const Float lod = hn::Add(material.real(word + HELIOGRAPH_WORD(Slot, lod)),
                            select(first, lookup.first_lod, lookup.second_lod));
  const Float4 texel = sample_texture<one_level>(scene, t, uv, lod);
  if (all(t.used)) return texel;
  return {select(t.used, texel.x, white.x), select(t.used, texel.y, white.y),
          select(t.used, texel.z, white.z), select(t.used, texel.w, white.w)};
}

/// The normal map about the front face's `normal`.
template <bool one_level>
HWY_INLINE Float3 mapped_normal(const SceneView& scene, const TriangleLanes& triangle,
                                const MatrixLanes& world, Float handedness, const Records& material,
                                const LookupLanes& lookup, const Float3& normal) {
  constexpr int slot = HELIOGRAPH_WORD(Material, normal_slot);
  const Integer used = hn::And(material.whole(slot + HELIOGRAPH_WORD(Slot, flags)),
                               integer(static_cast<int>(slot_used)));
  Mask mapped = float_mask(hn::Ne(used, integer(0)));
  if (none(mapped)) return normal;
  const Float4 texel = slot_texel<one_level>(scene, material, slot, lookup);
  const Float scale = material.real(HELIOGRAPH_WORD(Material, normal_scale));
  const Float2 slope{hn::Mul(hn::MulSub(texel.x, number(2.0f), one()), scale),
                     hn::Mul(hn::MulSub(texel.y, number(2.0f), one()), scale)};
  const Float height = hn::MulSub(texel.z, number(2.0f), one());
  constexpr int word = HELIOGRAPH_WORD(shared::Vertex, tangent);
  Float3 tangent = world.direction(triangle.between(word));
  tangent = tangent - normal * dot(normal, tangent);
  const Float size = dot(tangent, tangent);
  mapped = hn::And(mapped, hn::Ge(size, number(1e-12f)));
  tangent = tangent * hn::Div(one(), hn::Sqrt(at_least(size, 1e-30f)));
  const Float3 bitangent =
      cross(normal, tangent) * hn::Mul(triangle.a().real(word + 3), handedness);
  const Float3 turned =
      normalized(multiply_add(tangent, slope.x, multiply_add(bitangent, slope.y, normal * height)));
  return select(mapped, turned, normal);
}

HWY_INLINE Float4 vertex_color(const Records& vertex) {
  const auto pair = [&](int word, Float& low, Float& high) {
    const Integer packed = vertex.whole(word);
    const Float scale = number(1.0f / 65535.0f);
    low = hn::Mul(to_float(hn::And(packed, integer(0xffff))), scale);
    high = hn::Mul(to_float(as_integer(hn::ShiftRight<16>(as_unsigned(packed)))), scale);
  };
  Float4 color;
  pair(HELIOGRAPH_WORD(shared::Vertex, color_rg), color.x, color.y);
  pair(HELIOGRAPH_WORD(shared::Vertex, color_ba), color.z, color.w);
  return color;
}

template <bool one_level>
HWY_INLINE void evaluate_material(const SceneView& scene, const TriangleLanes& triangle,
                                  const Records& material, const LookupLanes& lookup,
                                  SurfaceLanes& s) {
  const auto factor = [&](int word) { return material.real(word); };
  const Float4 a = vertex_color(triangle.a()), b = vertex_color(triangle.b());
  const Float4 c = vertex_color(triangle.c());
  Float4 color =
      slot_texel<one_level>(scene, material, HELIOGRAPH_WORD(Material, base_color_slot), lookup);
  constexpr int base = HELIOGRAPH_WORD(Material, base_color);
  color.x = hn::Mul(hn::Mul(color.x, factor(base)), triangle.between(a.x, b.x, c.x));
  color.y = hn::Mul(hn::Mul(color.y, factor(base + 1)), triangle.between(a.y, b.y, c.y));
  color.z = hn::Mul(hn::Mul(color.z, factor(base + 2)), triangle.between(a.z, b.z, c.z));
  s.alpha = hn::Mul(hn::Mul(color.w, factor(base + 3)), triangle.between(a.w, b.w, c.w));
  s.base_color = clamped(Float3{color.x, color.y, color.z}, 0.0f, 1.0f);
  s.alpha_cutoff = factor(HELIOGRAPH_WORD(Material, alpha_cutoff));

  const Float4 packed = slot_texel<one_level>(
      scene, material, HELIOGRAPH_WORD(Material, metallic_roughness_slot), lookup);
  s.metallic = clamped(hn::Mul(factor(HELIOGRAPH_WORD(Material, metallic)), packed.z), 0.0f, 1.0f);
  s.roughness =
      clamped(hn::Mul(factor(HELIOGRAPH_WORD(Material, roughness)), packed.y), 0.0f, 1.0f);
  constexpr int occlusion_slot = HELIOGRAPH_WORD(Material, occlusion_slot);
  Float occlusion = slot_texel<one_level>(scene, material, occlusion_slot, lookup, slot_repeats).x;
  const Integer repeats = hn::And(material.whole(occlusion_slot + HELIOGRAPH_WORD(Slot, flags)),
                                  integer(static_cast<int>(slot_repeats)));
  occlusion = select(float_mask(hn::Ne(repeats, integer(0))), packed.x, occlusion);
  s.occlusion = mix(one(), occlusion, factor(HELIOGRAPH_WORD(Material, occlusion_strength)));
  const Float4 glow =
      slot_texel<one_level>(scene, material, HELIOGRAPH_WORD(Material, emissive_slot), lookup);
  s.emissive =
      material.triple(HELIOGRAPH_WORD(Material, emissive)) * Float3{glow.x, glow.y, glow.z};
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
  read_uv(triangle, HELIOGRAPH_WORD(shared::Vertex, uv0), footprint, lookup.first,
          lookup.first_lod);
  const Integer second = integer(static_cast<int>(uses_second_uv));
  if (!hn::AllFalse(integer_tag, hn::Eq(hn::And(uses, second), second))) {
    read_uv(triangle, HELIOGRAPH_WORD(shared::Vertex, uv1), footprint, lookup.second,
            lookup.second_lod);
  }
  return lookup;
}

/// `hit` of rays along `direction` whose footprints at the hits are `width` metres.
template <bool one_level>
HWY_INLINE SurfaceLanes hit_surface(const SceneView& scene, const HitLanes& hit,
                                    const Float3& direction, Float width) {
  const Records instance(scene.instances, hit.instance, sizeof(shared::Instance) / 4);
  const MatrixLanes world(instance, HELIOGRAPH_WORD(shared::Instance, world));
  const Records mesh(scene.meshes, instance.whole(HELIOGRAPH_WORD(shared::Instance, mesh)),
                     sizeof(shared::Mesh) / 4);
  const Records material(scene.materials, mesh.whole(HELIOGRAPH_WORD(shared::Mesh, material)),
                         sizeof(Material) / 4);
  const Integer first_index = hn::Add(mesh.whole(HELIOGRAPH_WORD(shared::Mesh, first_index)),
                                      hn::Mul(hit.triangle, integer(3)));
  const TriangleLanes triangle(scene.vertices, scene.indices, first_index,
                               mesh.whole(HELIOGRAPH_WORD(shared::Mesh, first_vertex)), hit,
                               hit.met);
  const Integer flipped = hn::And(instance.whole(HELIOGRAPH_WORD(shared::Instance, flags)),
                                  integer(static_cast<int>(shared::instance_flipped)));
  const Float handedness = select(float_mask(hn::Ne(flipped, integer(0))), number(-1.0f), one());

  SurfaceLanes s;
  constexpr int position = HELIOGRAPH_WORD(shared::Vertex, position);
  const Float3 a = triangle.a().triple(position), b = triangle.b().triple(position);
  const Float3 c = triangle.c().triple(position);
  s.local = triangle.between(a, b, c);
  s.position = world.point(s.local);
  // Cofactors of the matrix, as in gbuffer.vert.
  const Float3 by_x = cross(world.y, world.z) * handedness,
               by_y = cross(world.z, world.x) * handedness;
  const Float3 by_z = cross(world.x, world.y) * handedness;
  const auto turned = [&](const Records& vertex) {
    const Float3 n = vertex.triple(HELIOGRAPH_WORD(shared::Vertex, normal));
    return normalized(multiply_add(by_x, n.x, multiply_add(by_y, n.y, by_z * n.z)));
  };
  const Float3 vertex_normal = normalized(
      triangle.between(turned(triangle.a()), turned(triangle.b()), turned(triangle.c())));
  const Float3 across = cross(world.direction(b - a), world.direction(c - a)) * handedness;
  const Float area = hn::Sqrt(dot(across, across));
  const Mask flat = hn::Le(area, zero());
  s.front = select(flat, vertex_normal, across * hn::Div(one(), select(flat, one(), area)));
  const Float cosine = dot(s.front, direction);
  const Float side = select(hn::Le(cosine, zero()), one(), number(-1.0f));
  // Like the G-buffer: where winding and normals disagree, the normals say which side this is.
  const Mask opposed = hn::Lt(dot(s.front, vertex_normal), zero());
  s.geometric = s.front * select(opposed, hn::Neg(side), side);
  const LookupLanes lookup = texture_lookup(triangle, material, area, width, hn::Abs(cosine));
  s.normal = mapped_normal<one_level>(scene, triangle, world, handedness, material, lookup,
                                      vertex_normal) *
             side;
  evaluate_material<one_level>(scene, triangle, material, lookup, s);
  return s;
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
