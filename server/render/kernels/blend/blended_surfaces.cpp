#include "render/kernels/blend/blended.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_surfaces.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/blend/blended_layer.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes.
template <class Surface>
class BlendedHits {
 public:
  explicit BlendedHits(const BlendedSurfacesJob& job)
      : job_(job),
        shading_(job.frame, job.lit_scene.scene, job.deforms),
        layer_(job.frame, job.lit_scene,
               {job.radiance, job.transmittance, job.front_motion, job.chosen}, shading_,
               job.constants.round) {}

  /// `passed`: rays that go on. `lit`: those whose pixel has a surface to light.
  void block(int first, int last, RayBatch& passed, RayBatch& lit) const {
    const HitLanes hit = load_hits(job_.hits, first, last);
    if (none(hit.met)) return;
    RayLanes ray = load_rays(job_.met.rays, first, last);
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    HitRecords records(job_.lit_scene.scene, hit);
    records.triangle.set_point(hit.u, hit.v);
    const Surface s = shading_.surface(records, hit, ray.direction);
    const Mask open = hn::And(hit.met, is_open(s, ray.direction));
    const Mask blended = hn::AndNot(open, hn::And(hit.met, is_blended(s)));
    Mask goes_on = open;
    if (!none(blended)) {
      const auto found = layer_.lay_over(pixel, records, hit, s, ray.direction, blended);
      goes_on = hn::Or(goes_on, found.shows);
      lit.add(ray, found.first_lit);
    }
    if (job_.constants.last_round || none(goes_on)) return;
    ray.t_min = GBufferShading<Surface>::passed_from(hit.t);
    passed.add(ray, goes_on);
  }

 private:
  const BlendedSurfacesJob& job_;
  GBufferShading<Surface> shading_;
  BlendedLayer<Surface> layer_;
};

template <class Surface>
HWY_INLINE void blended_batch_of(const BlendedSurfacesJob& job, int first, int last) {
  const BlendedHits<Surface> surfaces(job);
  RayBatch passed, lit;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    surfaces.block(i, last, passed, lit);
  }
  passed.append_to(job.rays);
  lit.append_to(job.lit);
}

void blended_batch(const BlendedSurfacesJob& job, int first, int last) {
  if (job.lit_scene.layered) return blended_batch_of<LayeredSurfaceLanes>(job, first, last);
  blended_batch_of<SurfaceLanes>(job, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(blended_batch);

void blended_surfaces(const BlendedSurfacesJob& job) {
  for_each_batch(static_cast<int>(job.met.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(blended_batch)(job, first, last);
  });
  job.rays.end();
  job.lit.end();
}

}  // namespace heliograph::render::kernels
#endif
