#include "render/kernels/gbuffer/gbuffer_hits.hpp"

#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/gbuffer/gbuffer_hits.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/gbuffer/gbuffer_shading.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

void make_camera_rays(const shared::FrameConstants& frame, int tile, int tiles_across,
                      shared::Ray* to) {
  const CameraLanes camera(frame);
  const int tile_x = tile % tiles_across * 8, tile_y = tile / tiles_across * 8;
  const int lanes = static_cast<int>(hn::Lanes(tag));
  for (int i = 0; i < 64; i += lanes) {
    const Integer index = hn::Iota(integer_tag, i);
    const PixelLanes p{hn::Add(integer(tile_x), hn::And(index, integer(7))),
                       hn::Add(integer(tile_y), hn::ShiftRight<3>(index))};
    store_rays(camera_rays(frame, camera, p), hn::MaskFromVec(as_float(integer(-1))), to + i);
  }
}

/// The hits of one job, some at a time.
template <class Surface>
class StreamShading {
  using Shading = GBufferShading<Surface>;
  using AllTexels = TexelsOf<Surface>;

 public:
  explicit StreamShading(const GBufferHitsJob& job)
      : job_(job), shading_(job.frame, job.scene, job.deforms) {}

  /// `passed`: rays that go on.
  void block(int first, int last, RayBatch& passed) const {
    const Mask requested = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    RayLanes ray = load_rays(job_.rays.rays, first, last);
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    const HitLanes hit = load_hits(job_.hits, first, last);
    const Mask missed = hn::AndNot(hit.met, requested);
    if (!none(missed)) {
      store_texels(job_, empty_texels<AllTexels>(), pixel, hn::And(missed, inside(pixel)));
    }
    if (none(hit.met)) return;
    HitRecords records(job_.scene, hit);
    records.triangle.set_point(hit.u, hit.v);
    const Surface s = shading_.surface(records, hit, ray.direction);
    const Mask passes =
        job_.constants.last_round ? hn::Lt(one(), zero()) : shading_.go_on(ray.direction, hit, s);
    const Mask stays = hn::AndNot(passes, hit.met);
    if (!none(stays)) store_texels(job_, shading_.texels(pixel, records, hit, s), pixel, stays);
    if (none(passes)) return;
    ray.t_min = Shading::passed_from(hit.t);
    passed.add(ray, passes);
  }

 private:
  HWY_INLINE Mask inside(const PixelLanes& pixel) const {
    const glm::uvec2 extent = job_.frame.extent;
    return float_mask(hn::And(hn::Lt(pixel.x, integer(static_cast<int>(extent.x))),
                              hn::Lt(pixel.y, integer(static_cast<int>(extent.y)))));
  }

  const GBufferHitsJob& job_;
  Shading shading_;
};

template <class Surface>
HWY_INLINE void shade_batch_of(const GBufferHitsJob& job, int first, int last) {
  const StreamShading<Surface> shading(job);
  RayBatch passed;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    shading.block(i, last, passed);
  }
  passed.append_to(job.passed);
}

void shade_batch(const GBufferHitsJob& job, int first, int last) {
  if (job.layers) return shade_batch_of<LayeredSurfaceLanes>(job, first, last);
  shade_batch_of<SurfaceLanes>(job, first, last);
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
  const Rows rows = job.rows.within(static_cast<int>(frame.extent.y));
  const int above = across * (rows.top / 8);
  const int tiles = across * ((rows.bottom - rows.top + 7) / 8);
  *job.count = full_count(static_cast<std::uint32_t>(tiles) * 64, 0);
  for_each_range(tiles, 8, [&](int first, int last) {
    for (int tile = first; tile < last; ++tile) {
      HWY_DYNAMIC_DISPATCH(make_camera_rays)(frame, above + tile, across, job.rays + 64 * tile);
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
