// The triangles that rays have met, with what the scene's tables hold of them, a lane for every
// ray. Included once per instruction set.
#if defined(HELIOGRAPH_KERNELS_HIT_TRIANGLES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_HIT_TRIANGLES_HPP
#undef HELIOGRAPH_KERNELS_HIT_TRIANGLES_HPP
#else
#define HELIOGRAPH_KERNELS_HIT_TRIANGLES_HPP
#endif

#include "render/kernels/simd/lanes.hpp"
#include "render/kernels/simd/ray_writer.hpp"
#include "render/resources/host_tables.hpp"
#include "shaders/shared/ray.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

struct HitLanes {
  Mask met;
  Float t, u, v;
  Integer instance, triangle;  // of lanes that met nothing: another lane's
};

/// The hits from `first` on; lanes from `last` on count as misses.
HWY_INLINE HitLanes load_hits(const shared::Hit* hits, int first, int last) {
  static_assert(offsetof(shared::Hit, u) == 12 && offsetof(shared::Hit, v) == 16);
  const Float4 front = records_in_order(hits, 0, first, last);
  HitLanes h;
  h.instance = as_integer(front.y);
  const auto none_met = integer(static_cast<int>(shared::hit_none));
  const Mask requested = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
  h.met = hn::AndNot(float_mask(hn::Eq(h.instance, none_met)), requested);
  if (none(h.met)) return h;
  h.t = front.x;
  h.u = front.w;
  h.v = records_in_order(hits, 4, first, last).x;
  h.triangle = as_integer(front.z);
  const auto one_met = static_cast<std::size_t>(hn::FindFirstTrue(tag, h.met));
  h.instance = select(h.met, h.instance, integer(hn::ExtractLane(h.instance, one_met)));
  h.triangle = select(h.met, h.triangle, integer(hn::ExtractLane(h.triangle, one_met)));
  h.t = select(h.met, h.t, one());
  h.u = hn::IfThenElseZero(h.met, h.u);
  h.v = hn::IfThenElseZero(h.met, h.v);
  return h;
}

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

/// A vertex of every lane.
struct VertexLanes {
  Float3 position, normal;
  Float4 color, tangent, uv;  // both sets of uv
};

HWY_NOINLINE inline void read_vertex(const Records& from, VertexLanes& v) {
  static_assert(offsetof(shared::Vertex, normal) == 16 && offsetof(shared::Vertex, tangent) == 32 &&
                offsetof(shared::Vertex, uv0) == 48 && offsetof(shared::Vertex, uv1) == 56);
  const Float4 front = from.four(0), middle = from.four(4);
  v.position = {front.x, front.y, front.z};
  v.normal = {middle.x, middle.y, middle.z};
  v.tangent = from.four(8);
  v.uv = from.four(12);
  const auto pair = [](Float packed, Float& low, Float& high) HWY_ATTR {
    const Integer bits = as_integer(packed);
    const Float scale = number(1.0f / 65535.0f);
    low = hn::Mul(to_float(hn::And(bits, integer(0xffff))), scale);
    high = hn::Mul(to_float(as_integer(hn::ShiftRight<16>(as_unsigned(bits)))), scale);
  };
  pair(front.w, v.color.x, v.color.y);
  pair(middle.w, v.color.z, v.color.w);
}

/// The corners of each lane's triangle and their weights. Lanes that are not `requested` have the
/// first vertex three times.
class TriangleLanes {
 public:
  HWY_INLINE TriangleLanes(const shared::Vertex* vertices, const std::uint32_t* indices,
                           Integer first_index, Integer first_vertex, Mask requested) {
    for (int i = 0; i < 3; ++i) {
      const Integer index = hn::IfThenElseZero(integer_mask(requested),
                                               gather(indices, hn::Add(first_index, integer(i))));
      const Records vertex(vertices, hn::Add(first_vertex, index), sizeof(shared::Vertex) / 4);
      read_vertex(vertex, corners_[static_cast<std::size_t>(i)]);
    }
  }

  /// The point that between() is about.
  HWY_INLINE void set_point(Float u, Float v) {
    weight_a_ = hn::Sub(hn::Sub(one(), u), v);
    weight_b_ = u;
    weight_c_ = v;
  }
  HWY_INLINE Float between(Float a, Float b, Float c) const {
    return hn::MulAdd(a, weight_a_, hn::MulAdd(b, weight_b_, hn::Mul(c, weight_c_)));
  }
  HWY_INLINE Float3 between(const Float3& a, const Float3& b, const Float3& c) const {
    return multiply_add(a, weight_a_, multiply_add(b, weight_b_, c * weight_c_));
  }
  HWY_INLINE Float3 position() const { return between(a().position, b().position, c().position); }
  HWY_INLINE const VertexLanes& a() const { return corners_[0]; }
  HWY_INLINE const VertexLanes& b() const { return corners_[1]; }
  HWY_INLINE const VertexLanes& c() const { return corners_[2]; }

 private:
  std::array<VertexLanes, 3> corners_;
  Float weight_a_, weight_b_, weight_c_;
};

/// Unit vectors of the tangent plane at the front face's `normal`; lanes whose vertices have a
/// tangent.
HWY_INLINE Mask tangent_plane(const TriangleLanes& triangle, const MatrixLanes& world,
                              Float handedness, const Float3& normal, Float3& tangent,
                              Float3& bitangent) {
  const Float4 &a = triangle.a().tangent, &b = triangle.b().tangent, &c = triangle.c().tangent;
  tangent = world.direction(triangle.between({a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}));
  tangent = tangent - normal * dot(normal, tangent);
  const Float size = dot(tangent, tangent);
  tangent = tangent * hn::Div(one(), hn::Sqrt(at_least(size, 1e-30f)));
  bitangent = cross(normal, tangent) * hn::Mul(a.w, handedness);
  return hn::Ge(size, number(1e-12f));
}

/// What the tables hold of the triangles in `hit`.
struct HitRecords {
  Records instance;
  MatrixLanes world;
  Float handedness;
  Float scale;  // mesh -> world, of the thickness of volumes
  Float4 mesh;
  Records material;
  TriangleLanes triangle;

  HWY_INLINE HitRecords(const SceneView& scene, const HitLanes& hit)
      : instance(scene.instances, hit.instance, sizeof(shared::Instance) / 4),
        world(instance, HELIOGRAPH_WORD(shared::Instance, world)),
        handedness(one()),
        scale(one()),
        mesh(mesh_of(scene, instance, handedness, scale)),
        material(scene.materials, as_integer(mesh.w), sizeof(Material) / 4),
        triangle(scene.vertices, scene.indices,
                 hn::Add(as_integer(mesh.x), hn::Mul(hit.triangle, integer(3))), as_integer(mesh.z),
                 hit.met) {}

 private:
  static HWY_INLINE Float4 mesh_of(const SceneView& scene, const Records& instance,
                                   Float& handedness, Float& scale) {
    static_assert(offsetof(shared::Instance, flags) == offsetof(shared::Instance, mesh) + 4 &&
                  offsetof(shared::Instance, scale) == offsetof(shared::Instance, mesh) + 12);
    const Float4 attributes = instance.four(HELIOGRAPH_WORD(shared::Instance, mesh));
    const Integer flipped =
        hn::And(as_integer(attributes.y), integer(static_cast<int>(shared::instance_flipped)));
    handedness = select(float_mask(hn::Ne(flipped, integer(0))), number(-1.0f), one());
    scale = attributes.w;
    static_assert(offsetof(shared::Mesh, first_vertex) == 8 &&
                  offsetof(shared::Mesh, material) == 12);
    return Records(scene.meshes, as_integer(attributes.x), sizeof(shared::Mesh) / 4).four(0);
  }
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
