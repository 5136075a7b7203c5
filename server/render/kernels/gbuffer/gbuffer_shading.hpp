// The G-buffer's texels of what camera rays meet, a lane for every ray. Included once per
// instruction set; the guard is Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_GBUFFER_SHADING_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_GBUFFER_SHADING_HPP
#undef HELIOGRAPH_KERNELS_GBUFFER_SHADING_HPP
#else
#define HELIOGRAPH_KERNELS_GBUFFER_SHADING_HPP
#endif

#include "render/kernels/simd/ray_writer.hpp"
#include "render/kernels/simd/surface.hpp"

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
  Float4 normals, motion;
  Float2 depth_slope, emissive;
  Float base_color, surface, instance;
};

/// Where no surface is.
HWY_INLINE GBufferTexels empty_texels() {
  // Beyond the octahedron: no normal.
  const Float none_of_it = zero(), beyond = number(2.0f);
  return {{beyond, beyond, beyond, beyond},
          {none_of_it, none_of_it, none_of_it, none_of_it},
          {none_of_it, none_of_it},
          {none_of_it, none_of_it},
          none_of_it,
          none_of_it,
          none_of_it};
}

class GBufferShading {
 public:
  GBufferShading(const shared::FrameConstants& frame, const SceneView& scene, bool deforms)
      : frame_(frame), scene_(scene), deforms_(deforms), camera_(frame), cone_(camera_.cone()) {}

  HWY_INLINE const CameraLanes& camera() const { return camera_; }

  /// The surfaces at `hit`, whose u and v `records` have.
  HWY_INLINE SurfaceLanes surface(const HitRecords& records, const HitLanes& hit,
                                  const Float3& direction) const {
    const Float width = hn::MulAdd(hit.t, number(cone_.y), number(cone_.x));
    return surface_at<false>(scene_, records, direction, width);
  }

  /// Rays that the surfaces let pass.
  HWY_INLINE Mask go_on(const Float3& direction, const HitLanes& hit, const SurfaceLanes& s) const {
    const Mask back = hn::Gt(dot(s.front, direction), zero());
    Mask passes = hn::AndNot(s.has(shared::material_double_sided), back);
    // Tracers test the nearest texel; the frame shows the filtered one, as rasterised triangles do.
    const Mask masked = s.has(shared::material_alpha_mask);
    passes = hn::Or(passes, hn::And(masked, hn::Lt(s.alpha, s.alpha_cutoff)));
    // Of blended surfaces only the opaque part: the rest is blended over the frame.
    const Mask blends = s.has(shared::material_alpha_blend);
    passes = hn::Or(passes, hn::And(blends, hn::Lt(s.alpha, number(shared::least_solid))));
    return hn::And(passes, hit.met);
  }

  HWY_INLINE GBufferTexels texels(const PixelLanes& pixel, const HitRecords& records,
                                  const HitLanes& hit, const SurfaceLanes& s) const {
    const Float view_z = hn::Neg(transform_row(frame_.view, 2, s.position));
    const Float2 shading = octahedral_encode(s.normal), flat = octahedral_encode(s.geometric);
    const auto half = [](Float low, Float high) HWY_ATTR {
      return as_float(hn::Or(half_bits(low), hn::ShiftLeft<16>(half_bits(high))));
    };
    const Float4 color{hn::Sqrt(s.base_color.x), hn::Sqrt(s.base_color.y), hn::Sqrt(s.base_color.z),
                       s.occlusion};
    const Float unlit = hn::IfThenElseZero(s.has(shared::material_unlit), one());
    return {{shading.x, shading.y, flat.x, flat.y},
            motion(records.instance, hit, s, view_z),
            plane_slope(pixel, s, view_z),
            {half(s.emissive.x, s.emissive.y), half(s.emissive.z, one())},
            as_float(pack_unorm8(color)),
            as_float(pack_unorm8({s.roughness, s.metallic, unlit, zero()})),
            as_float(hn::Add(hit.instance, integer(1)))};
  }

  /// From a little behind the surface on.
  static HWY_INLINE Float passed_from(Float t) {
    return t + hn::Max(t * number(1e-6f), number(1e-7f));
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

  const shared::FrameConstants& frame_;
  const SceneView& scene_;
  bool deforms_;
  CameraLanes camera_;
  glm::vec2 cone_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
