// The G-buffer's texels of what camera rays meet, a lane for every ray. Included once per
// instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_GBUFFER_SHADING_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_GBUFFER_SHADING_HPP
#undef HELIOGRAPH_KERNELS_GBUFFER_SHADING_HPP
#else
#define HELIOGRAPH_KERNELS_GBUFFER_SHADING_HPP
#endif

#include "render/kernels/simd/material/hit_material.hpp"
#include "render/kernels/simd/material/packed_layer.hpp"
#include "render/kernels/simd/ray_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// The rays through the samples of pixels.
HWY_INLINE RayLanes camera_rays(const shared::FrameConstants& frame, const CameraLanes& camera,
                                const PixelLanes& p) {
  const bool orthographic = camera.orthographic();
  // The near plane is what the reversed projection leaves of every point's depth.
  const float near_plane = orthographic ? 0.0f : frame.unjittered[3][2];
  RayLanes ray;
  ray.origin = orthographic ? camera.world_position(p, zero()) : numbers(glm::vec3(frame.eye));
  ray.direction = -camera.to_eye(p);
  ray.t_min = number(near_plane) * length(camera.view_position(p, one()));
  const Mask inside = float_mask(hn::And(hn::Lt(p.x, integer(static_cast<int>(frame.extent.x))),
                                         hn::Lt(p.y, integer(static_cast<int>(frame.extent.y)))));
  ray.t_max = select(inside, number(1e30f), number(-1.0f));
  ray.pixel = pack_pixel(p);
  ray.user = numbers(0.0f);
  return ray;
}

/// A texel of every image.
struct GBufferTexels {
  static constexpr bool layered = false;
  Float4 normals, motion;
  Float2 depth_slope, emissive;
  Float base_color, surface, instance;
};
struct LayeredTexels : GBufferTexels {
  static constexpr bool layered = true;
  Float4 layers;
};
template <class Surface>
using TexelsOf = std::conditional_t<Surface::layered, LayeredTexels, GBufferTexels>;

/// Where no surface is.
template <class Texels>
HWY_INLINE Texels empty_texels() {
  // Beyond the octahedron: no normal.
  const Float none_of_it = zero(), beyond = number(2.0f);
  Texels texels;
  texels.normals = {beyond, beyond, beyond, beyond};
  texels.motion = {none_of_it, none_of_it, none_of_it, none_of_it};
  texels.depth_slope = texels.emissive = {none_of_it, none_of_it};
  texels.base_color = texels.surface = texels.instance = none_of_it;
  if constexpr (Texels::layered) texels.layers = texels.motion;
  return texels;
}

/// Stores texels at pixels anywhere in the images of `job`.
template <class AllTexels, class Job>
HWY_NOINLINE void store_texels(const Job& job, const AllTexels& texels, const PixelLanes& pixel,
                               Mask requested) {
  const Texels<4> normals(texels.normals), motion(texels.motion);
  const Texels<2> depth_slope(texels.depth_slope), emissive(texels.emissive);
  const Texels<1> base_color(texels.base_color), surface(texels.surface);
  const Texels<1> instance(texels.instance);
  const TexelIndices at(pixel);
  for_each_run(requested, pixel, [&](std::size_t lane, std::size_t count) {
    normals.put(job.normals, lane, count, at);
    motion.put(job.motion, lane, count, at);
    depth_slope.put(job.depth_slope, lane, count, at);
    emissive.put(job.emissive, lane, count, at);
    base_color.put(job.base_color, lane, count, at);
    surface.put(job.surface, lane, count, at);
    instance.put(job.instance, lane, count, at);
  });
  if constexpr (AllTexels::layered) {
    const Texels<4> layers(texels.layers);
    for_each_lane(requested, [&](std::size_t lane) { layers.put(job.layers, lane, at); });
  }
}

/// encode_grain() of shaders/lib/scene/layers.glsl
HWY_INLINE Float encode_grain(const Float3& grain, const Float3& normal) {
  Float3 tangent, bitangent;
  storage_basis(normal, tangent, bitangent);
  const Float x = dot(grain, tangent), y = dot(grain, bitangent);
  const Float share = y / at_least(hn::Abs(x) + hn::Abs(y), 1e-12f);
  const Float turned = select(hn::Ge(x, zero()), share, hn::Neg(share));
  return hn::MulAdd(turned, number(0.5f), number(0.5f));
}

/// Replaces `packed` in lanes with grain.
HWY_INLINE void pack_grain(const SurfaceLayer<Float>& layer, const Float3& normal,
                           const Float2& coat_normal, Float4& packed) {
  const Mask grained = hn::Gt(layer.anisotropy, zero());
  if (none(grained)) return;
  const auto steps = [](Float value, float most) HWY_ATTR {
    return truncated(hn::MulAdd(clamped(value, 0.0f, 1.0f), number(most), number(0.5f)));
  };
  const auto half = [](Float value)
                        HWY_ATTR { return hn::MulAdd(value, number(0.5f), number(0.5f)); };
  const Integer coat = hn::Or(steps(half(coat_normal.x), 4094.0f),
                              hn::ShiftLeft<12>(steps(half(coat_normal.y), 4094.0f)));
  const Integer strength = steps(layer.anisotropy, 255.0f);
  const Integer direction = steps(encode_grain(layer.grain, normal), 255.0f);
  const auto sixth = [&](Float value) HWY_ATTR { return steps(value, 63.0f); };
  const Integer sheen = hn::Or(
      hn::Or(sixth(hn::Sqrt(layer.sheen.x)), hn::ShiftLeft<6>(sixth(hn::Sqrt(layer.sheen.y)))),
      hn::Or(hn::ShiftLeft<12>(sixth(hn::Sqrt(layer.sheen.z))),
             hn::ShiftLeft<18>(sixth(layer.sheen_roughness))));
  const Integer flag = integer(static_cast<int>(packed_grain));
  packed.x = select(grained, as_float(hn::Or(as_integer(packed.x), flag)), packed.x);
  packed.y = select(grained, as_float(hn::Or(coat, hn::ShiftLeft<24>(strength))), packed.y);
  packed.w = select(grained, as_float(hn::Or(sheen, hn::ShiftLeft<24>(direction))), packed.w);
}

/// Replaces `packed` in lanes that scatter light to their other side.
HWY_INLINE void pack_tint(const SurfaceLayer<Float>& layer, Float4& packed) {
  const Mask tinted = hn::Gt(layer.diffuse_transmission, zero());
  if (none(tinted)) return;
  const auto root = [](Float value) HWY_ATTR {
    return truncated(
        hn::MulAdd(hn::Sqrt(clamped(value, 0.0f, 1.0f)), number(255.0f), number(0.5f)));
  };
  const Float3& tint = layer.diffuse_tint;
  const Integer color =
      hn::Or(root(tint.x), hn::Or(hn::ShiftLeft<8>(root(tint.y)), hn::ShiftLeft<16>(root(tint.z))));
  const Integer strength =
      hn::IfThenElseZero(integer_mask(hn::Gt(layer.anisotropy, zero())),
                         hn::And(as_integer(packed.y), integer(static_cast<int>(0xff000000u))));
  const Integer flag = integer(static_cast<int>(packed_tint));
  packed.x = select(tinted, as_float(hn::Or(as_integer(packed.x), flag)), packed.x);
  packed.y = select(tinted, as_float(hn::Or(color, strength)), packed.y);
}

/// pack_layer() of shaders/lib/scene/layers.glsl
HWY_INLINE Float4 pack_layer(const SurfaceLayer<Float>& layer, Float roughness,
                             const Float3& shading_normal) {
  const auto tenth = [](Float value) HWY_ATTR {
    const Float root = hn::Sqrt(clamped(value, 0.0f, 1.0f));
    return truncated(hn::MulAdd(root, number(1023.0f), number(0.5f)));
  };
  const auto snorm = [](Float value) HWY_ATTR {
    return hn::NearestInt(clamped(value, -1.0f, 1.0f) * number(32767.0f));
  };
  const Float2 normal = octahedral_encode(layer.coat_normal);
  const Integer f0 = hn::Or(tenth(layer.f0.x), hn::Or(hn::ShiftLeft<10>(tenth(layer.f0.y)),
                                                      hn::ShiftLeft<20>(tenth(layer.f0.z))));
  const Integer packed_normal =
      hn::Or(hn::And(snorm(normal.x), integer(0xffff)), hn::ShiftLeft<16>(snorm(normal.y)));
  const Float3& sheen = layer.sheen;
  Float4 packed{as_float(f0), as_float(packed_normal),
                as_float(pack_unorm8({layer.coat, layer.coat_roughness, roughness, layer.f90})),
                as_float(pack_unorm8({hn::Sqrt(sheen.x), hn::Sqrt(sheen.y), hn::Sqrt(sheen.z),
                                      layer.sheen_roughness}))};
  pack_grain(layer, shading_normal, normal, packed);
  pack_tint(layer, packed);
  return packed;
}

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes.
template <class Surface>
class GBufferShading {
 public:
  GBufferShading(const shared::FrameConstants& frame, const SceneView& scene, bool deforms)
      : frame_(frame), scene_(scene), deforms_(deforms), camera_(frame), cone_(camera_.cone()) {}

  HWY_INLINE const CameraLanes& camera() const { return camera_; }

  /// The surfaces at `hit`, whose u and v `records` have.
  HWY_INLINE Surface surface(const HitRecords& records, const HitLanes& hit,
                             const Float3& direction) const {
    const Float width = hn::MulAdd(hit.t, number(cone_.y), number(cone_.x));
    return surface_at<Surface, false>(scene_, records, direction, width);
  }

  /// Rays that the surfaces let pass.
  HWY_INLINE Mask go_on(const Float3& direction, const HitLanes& hit, const Surface& s) const {
    // Of blended surfaces only the opaque part is drawn: the rest is blended over the frame.
    return hn::And(hn::Or(is_open(s, direction), is_blended(s)), hit.met);
  }

  HWY_INLINE TexelsOf<Surface> texels(const PixelLanes& pixel, const HitRecords& records,
                                      const HitLanes& hit, const Surface& s) const {
    const Float view_z = hn::Neg(transform_row(frame_.view, 2, s.position));
    const Float2 shading = octahedral_encode(s.normal), flat = octahedral_encode(s.geometric);
    const auto half = [](Float low, Float high) HWY_ATTR {
      return as_float(hn::Or(half_bits(low), hn::ShiftLeft<16>(half_bits(high))));
    };
    const Float4 color{hn::Sqrt(s.base_color.x), hn::Sqrt(s.base_color.y), hn::Sqrt(s.base_color.z),
                       s.occlusion};
    const Float unlit = hn::IfThenElseZero(s.has(shared::material_unlit), one());
    TexelsOf<Surface> to;
    to.normals = {shading.x, shading.y, flat.x, flat.y};
    to.motion = motion(records.instance, hit, s, view_z);
    to.depth_slope = plane_slope(pixel, s, view_z);
    to.emissive = {half(s.emissive.x, s.emissive.y), half(s.emissive.z, one())};
    to.base_color = as_float(pack_unorm8(color));
    Float roughness = s.roughness, through = zero();
    if constexpr (Surface::layered) {
      to.layers = pack_layer(s.layer, roughness, s.normal);
      const Mask coated = hn::Gt(s.layer.coat, zero());
      roughness = select(coated, hn::Min(roughness, s.layer.coat_roughness), roughness);
      through = s.layer.diffuse_transmission;
    }
    to.surface = as_float(pack_unorm8({roughness, s.metallic, unlit, through}));
    to.instance = as_float(hn::Add(hit.instance, integer(1)));
    return to;
  }

  /// From a little behind the surface on.
  static HWY_INLINE Float passed_from(Float t) {
    return t + hn::Max(t * number(1e-6f), number(1e-7f));
  }

  HWY_INLINE Float4 motion(const Records& instance, const HitLanes& hit, const SurfaceLanes& s,
                           Float view_z) const {
    const MatrixLanes before(instance, HELIOGRAPH_WORD(shared::Instance, previous_world));
    const Float3 previous = before.point(previous_local(instance, hit, s));
    const auto project = [](const glm::mat4& m, const Float3& at) {
      const Float by = transform_row(m, 3, at);
      return Float2{transform_row(m, 0, at) / by, transform_row(m, 1, at) / by};
    };
    const Float2 now = project(frame_.unjittered, s.position);
    const Float2 then = project(frame_.previous_unjittered, previous);
    const Float z_before = hn::Neg(transform_row(frame_.previous_view, 2, previous));
    // Equal positions give exactly 0: no product is here that the compiler could fuse with this.
    return {(then.x - now.x) * number(0.5f), (then.y - now.y) * number(0.5f), z_before - view_z,
            view_z};
  }

 private:
  /// Change of view Z from one pixel to the next on the surface's plane.
  HWY_INLINE Float2 plane_slope(const PixelLanes& pixel, const SurfaceLanes& s,
                                Float view_z) const {
    const glm::mat4& m = frame_.inverse_view;
    const Float3 n{dot(numbers(glm::vec3(m[0])), s.geometric),
                   dot(numbers(glm::vec3(m[1])), s.geometric),
                   dot(numbers(glm::vec3(m[2])), s.geometric)};
    const Float2 here = camera_.slope(pixel);
    const Float2 right = camera_.slope(pixel, 1.5f, 0.5f), below = camera_.slope(pixel, 0.5f, 1.5f);
    if (camera_.orthographic()) {
      const Float by = select(hn::Lt(hn::Abs(n.z), number(1e-4f)), number(1e-4f), n.z);
      return {n.x * (right.x - here.x) / by, n.y * (below.y - here.y) / by};
    }
    const Float at = view_z * hn::MulAdd(n.x, here.x, hn::MulSub(n.y, here.y, n.z));
    const auto slope = [&](const Float2& through) {
      const Float along = hn::MulAdd(n.x, through.x, hn::MulSub(n.y, through.y, n.z));
      const Float by = select(hn::Lt(hn::Abs(along), number(1e-6f)), number(1e-6f), along);
      return hn::Min(hn::Max(at / by - view_z, hn::Neg(view_z)), view_z);
    };
    return {slope(right), slope(below)};
  }

  /// Where the points of the triangles were in their meshes one frame ago.
  HWY_INLINE Float3 previous_local(const Records& instance, const HitLanes& hit,
                                   const SurfaceLanes& s) const {
    if (!deforms_) return s.local;
    const Integer base = instance.whole(HELIOGRAPH_WORD(shared::Instance, previous_vertex));
    const Mask moved = hn::And(hit.met, float_mask(hn::Ne(base, integer(0))));
    if (none(moved)) return s.local;
    const Records mesh(scene_.meshes, instance.whole(HELIOGRAPH_WORD(shared::Instance, mesh)),
                       sizeof(shared::Mesh) / 4);
    // Lanes whose mesh keeps its shape read any vertex of a frame ago: the first.
    const Integer first_index =
        select(moved,
               hn::Add(mesh.whole(HELIOGRAPH_WORD(shared::Mesh, first_index)),
                       hn::Mul(hit.triangle, integer(3))),
               integer(0));
    const Integer first_vertex = hn::Sub(hn::Max(base, integer(1)), integer(1));
    TriangleLanes before(scene_.previous_vertices, scene_.indices, first_index, first_vertex,
                         moved);
    before.set_point(hit.u, hit.v);
    return select(moved, before.position(), s.local);
  }

  const shared::FrameConstants& frame_;
  const SceneView& scene_;
  bool deforms_;
  CameraLanes camera_;
  glm::vec2 cone_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
