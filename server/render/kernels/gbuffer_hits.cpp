#include "render/kernels/gbuffer_hits.hpp"

#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/gbuffer_hits.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/ray_writer.hpp"
#include "render/kernels/simd/surface.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

void make_camera_rays(const shared::FrameConstants& frame, int tile, int tiles_across,
                      shared::Ray* to) {
  const CameraLanes camera(frame);
  const bool orthographic = camera.orthographic();
  // The near plane is what the reversed projection leaves of every point's depth.
  const float near_plane = orthographic ? 0.0f : frame.unjittered[3][2];
  const int tile_x = tile % tiles_across * 8, tile_y = tile / tiles_across * 8;
  const int lanes = static_cast<int>(hn::Lanes(tag));
  for (int i = 0; i < 64; i += lanes) {
    const Integer index = hn::Iota(integer_tag, i);
    const PixelLanes p{hn::Add(integer(tile_x), hn::And(index, integer(7))),
                       hn::Add(integer(tile_y), hn::ShiftRight<3>(index))};
    RayLanes ray;
    ray.origin = orthographic ? camera.world_position(p, zero()) : numbers(glm::vec3(frame.eye));
    ray.direction = -camera.to_eye(p);
    ray.t_min = number(near_plane) * length(camera.view_position(p, one()));
    const Mask inside = float_mask(hn::And(hn::Lt(p.x, integer(static_cast<int>(frame.extent.x))),
                                           hn::Lt(p.y, integer(static_cast<int>(frame.extent.y)))));
    ray.t_max = select(inside, number(1e30f), number(-1.0f));
    ray.pixel = pack_pixel(p);
    ray.user = numbers(0.0f);
    store_rays(ray, hn::MaskFromVec(as_float(integer(-1))), to + i);
  }
}

/// The hits of one job, some at a time.
class Shading {
 public:
  explicit Shading(const GBufferHitsJob& job)
      : job_(job), frame_(job.frame), camera_(job.frame), cone_(camera_.cone()) {}

  /// @return how many rays go on, which lie at `passed`
  std::size_t block(int first, int last, shared::Ray* passed) const {
    const Integer lane = hn::Iota(integer_tag, first);
    const Integer index = hn::Min(lane, integer(last - 1));
    const Mask requested = float_mask(hn::Lt(lane, integer(last)));
    RayLanes ray = load_rays(job_.rays.rays, index);
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    const HitLanes hit = load_hits(job_.hits, index, requested);
    const Mask missed = hn::AndNot(hit.met, requested);
    if (!none(missed)) store_nothing(pixel, missed);
    if (none(hit.met)) return 0;
    const Float width = hn::MulAdd(hit.t, number(cone_.y), number(cone_.x));
    const SurfaceLanes s = hit_surface<false>(job_.scene, hit, ray.direction, width);
    const Mask passes = job_.constants.last_round ? hn::Lt(one(), zero()) : goes_on(ray, hit, s);
    store(pixel, hit, s, hn::AndNot(passes, hit.met));
    if (none(passes)) return 0;
    ray.t_min = hit.t + hn::Max(hit.t * number(1e-6f), number(1e-7f));
    return store_rays(ray, passes, passed);
  }

 private:
  HWY_INLINE Mask goes_on(const RayLanes& ray, const HitLanes& hit, const SurfaceLanes& s) const {
    const Mask back = hn::Gt(dot(s.front, ray.direction), zero());
    Mask passes = hn::AndNot(s.has(shared::material_double_sided), back);
    // Tracers test the nearest texel; the frame shows the filtered one, as rasterised triangles do.
    const Mask masked = s.has(shared::material_alpha_mask);
    passes = hn::Or(passes, hn::And(masked, hn::Lt(s.alpha, s.alpha_cutoff)));
    // Of blended surfaces only the opaque part: the rest is blended over the frame.
    const Mask blends = s.has(shared::material_alpha_blend);
    passes = hn::Or(passes, hn::And(blends, hn::Lt(s.alpha, number(shared::least_solid))));
    return hn::And(passes, hit.met);
  }

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
    if (!job_.deforms) return s.local;
    const Integer base = instance.whole(HELIOGRAPH_WORD(shared::Instance, previous_vertex));
    const Mask moved = hn::And(hit.met, float_mask(hn::Ne(base, integer(0))));
    if (none(moved)) return s.local;
    const Records mesh(job_.scene.meshes, instance.whole(HELIOGRAPH_WORD(shared::Instance, mesh)),
                       sizeof(shared::Mesh) / 4);
    // Lanes whose mesh keeps its shape read any vertex of a frame ago: the first.
    const Integer first_index =
        select(moved,
               hn::Add(mesh.whole(HELIOGRAPH_WORD(shared::Mesh, first_index)),
                       hn::Mul(hit.triangle, integer(3))),
               integer(0));
    const Integer first_vertex = hn::Sub(hn::Max(base, integer(1)), integer(1));
    const TriangleLanes before(job_.scene.previous_vertices, job_.scene.indices, first_index,
                               first_vertex, hit, moved);
    return select(moved, before.between(HELIOGRAPH_WORD(shared::Vertex, position)), s.local);
  }

  HWY_INLINE Float4 motion(const HitLanes& hit, const SurfaceLanes& s, Float view_z) const {
    const Records instance(job_.scene.instances, hit.instance, sizeof(shared::Instance) / 4);
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

  /// Of all images.
  struct AllTexels {
    Texels<4> normals, motion;
    Texels<2> depth_slope, emissive;
    Texels<1> base_color, surface, instance;
  };

  HWY_INLINE void put(const AllTexels& texels, const PixelLanes& pixel, Mask requested) const {
    const TexelIndices at(pixel);
    for_each_lane(requested, [&](std::size_t lane) {
      texels.normals.put(job_.normals, lane, at);
      texels.motion.put(job_.motion, lane, at);
      texels.depth_slope.put(job_.depth_slope, lane, at);
      texels.emissive.put(job_.emissive, lane, at);
      texels.base_color.put(job_.base_color, lane, at);
      texels.surface.put(job_.surface, lane, at);
      texels.instance.put(job_.instance, lane, at);
    });
  }

  HWY_INLINE void store(const PixelLanes& pixel, const HitLanes& hit, const SurfaceLanes& s,
                        Mask requested) const {
    if (none(requested)) return;
    const Float view_z = hn::Neg(transform_row(frame_.view, 2, s.position));
    const Float2 shading = octahedral_encode(s.normal), flat = octahedral_encode(s.geometric);
    const auto half = [](Float low, Float high) {
      return as_float(hn::Or(half_bits(low), hn::ShiftLeft<16>(half_bits(high))));
    };
    const Float4 color{hn::Sqrt(s.base_color.x), hn::Sqrt(s.base_color.y), hn::Sqrt(s.base_color.z),
                       s.occlusion};
    const Float unlit = hn::IfThenElseZero(s.has(shared::material_unlit), one());
    const AllTexels out{
        Texels<4>(Float4{shading.x, shading.y, flat.x, flat.y}),
        Texels<4>(motion(hit, s, view_z)),
        Texels<2>(plane_slope(pixel, s, view_z)),
        Texels<2>(Float2{half(s.emissive.x, s.emissive.y), half(s.emissive.z, one())}),
        Texels<1>(as_float(pack_unorm8(color))),
        Texels<1>(as_float(pack_unorm8({s.roughness, s.metallic, unlit, zero()}))),
        Texels<1>(as_float(hn::Add(hit.instance, integer(1))))};
    put(out, pixel, requested);
  }

  HWY_INLINE void store_nothing(const PixelLanes& pixel, Mask missed) const {
    const Mask inside =
        float_mask(hn::And(hn::Lt(pixel.x, integer(static_cast<int>(frame_.extent.x))),
                           hn::Lt(pixel.y, integer(static_cast<int>(frame_.extent.y)))));
    const Float none_of_it = zero();
    const Float2 two{none_of_it, none_of_it};
    const Float4 four{none_of_it, none_of_it, none_of_it, none_of_it};
    // Beyond the octahedron: no normal.
    const Float beyond = number(2.0f);
    const Float4 no_normal{beyond, beyond, beyond, beyond};
    const AllTexels nothing{Texels<4>(no_normal), Texels<4>(four),       Texels<2>(two),
                            Texels<2>(two),       Texels<1>(none_of_it), Texels<1>(none_of_it),
                            Texels<1>(none_of_it)};
    put(nothing, pixel, hn::And(missed, inside));
  }

  const GBufferHitsJob& job_;
  const shared::FrameConstants& frame_;
  CameraLanes camera_;
  glm::vec2 cone_;
};

void shade_batch(const GBufferHitsJob& job, int first, int last) {
  const Shading shading(job);
  std::array<shared::Ray, ray_batch> passed;
  std::size_t used = 0;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    used += shading.block(i, last, passed.data() + used);
  }
  if (used) job.passed.append({passed.data(), used});
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(make_camera_rays);
HWY_EXPORT(shade_batch);

void gbuffer_rays(const GBufferRaysJob& job) {
  const shared::FrameConstants& frame = job.frame;
  const auto across = static_cast<int>((frame.extent.x + 7) / 8);
  const auto tiles = across * static_cast<int>((frame.extent.y + 7) / 8);
  *job.count = {static_cast<std::uint32_t>(tiles) * 64, 0, 0, 1, 0, 0, 0, 0};
  set_groups(*job.count);
  for_each_range(tiles, 8, [&](int first, int last) {
    for (int tile = first; tile < last; ++tile) {
      HWY_DYNAMIC_DISPATCH(make_camera_rays)(frame, tile, across, job.rays + 64 * tile);
    }
  });
}

void gbuffer_hits(const GBufferHitsJob& job) {
  const auto count = static_cast<int>(job.rays.count->count);
  for_each_batch(count, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(shade_batch)(job, first, last);
  });
  job.passed.end();
}

}  // namespace heliograph::render::kernels
#endif
