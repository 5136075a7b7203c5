#include "render/kernels/blend/blended.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_enter.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/blend/chosen_hit.hpp"
#include "render/kernels/simd/material/transmission.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Rays into the volumes that chosen surfaces enclose, or through the thin walls that they are.
/// Materials have layers.
class BlendedEntry {
 public:
  explicit BlendedEntry(const BlendedEnterJob& job)
      : job_(job),
        scene_(job.lit_scene.scene),
        cone_(CameraLanes(job.frame).cone()),
        tables_(job.lit_scene.tables),
        entries_(unsigned_tag, job.frame.sample_index, shared::entry_dimension, job.frame.seed),
        bands_(job.frame) {}

  void block(int first, int last, RayBatch& inside, RayBatch& refracted) const {
    const RayLanes view = load_rays(job_.lit.rays, first, last);
    const PixelLanes pixel = unpack_pixel(view.pixel);
    const Mask lanes = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    Float3 throughput;
    const HitLanes hit = chosen_hit(job_, pixel, lanes, throughput);
    const Float width = hn::MulAdd(hit.t, number(cone_.y), number(cone_.x));
    auto s = hit_surface<LayeredSurfaceLanes, false>(scene_, hit, view.direction, width);
    const BoundaryLanes boundary = boundary_of(scene_, hit, s, view.direction);
    const Mask bends = hn::And(lanes, bends_light(job_.frame, s, boundary));
    if (none(bends)) return;
    // Volumes attenuate light along its way through them.
    const Float whole = s.layer.transmission;
    s.layer.transmitted = {whole, whole, whole};
    const LayeredMaterial<Float> m = material_of(s, view.direction, tables_);
    const Integer band = bands_.at(scene_, boundary.medium, pixel);
    RayLanes ray;
    const Float view_z = hn::Neg(transform_row(job_.frame.view, 2, s.position));
    ray.origin = offset_origin(s.position, -m.geometric, view_z);
    ray.t_min = zero();
    ray.t_max = number(1e30f);
    ray.pixel = view.pixel;
    Float2 u;
    entries_.at(as_unsigned(pixel.x), as_unsigned(pixel.y), u.x, u.y);
    ray.direction = sample_transmitted(m, refraction_index(scene_, boundary.medium, band), u);
    ray.user = throughput * m.transmitted * Float3{share(band, 1), share(band, 2), share(band, 3)};
    const Mask carries = hn::And(bends, hn::Gt(largest_of(m.transmitted), zero()));
    const Mask enters = hn::And(carries, float_mask(hn::Gt(boundary.medium, integer(0))));
    inside.add(ray, enters);
    refracted.add(ray, hn::AndNot(enters, carries));
  }

 private:
  /// What a ray of `band` carries of that color: all of it stands for all three.
  static HWY_INLINE Float share(Integer band, int color) {
    const Mask chosen = float_mask(hn::Eq(band, integer(color)));
    const Mask all_bands = float_mask(hn::Eq(band, integer(0)));
    return select(all_bands, one(), hn::IfThenElseZero(chosen, number(3.0f)));
  }

  const BlendedEnterJob& job_;
  const SceneView& scene_;
  glm::vec2 cone_;
  LobeLanes<Tag> tables_;
  RandomPairs<UnsignedTag> entries_;
  PixelBands bands_;
};

void enter_batch(const BlendedEnterJob& job, int first, int last) {
  const BlendedEntry entry(job);
  RayBatch inside, refracted;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    entry.block(i, last, inside, refracted);
  }
  inside.append_to(job.inside);
  refracted.append_to(job.refracted);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(enter_batch);

void blended_enter(const BlendedEnterJob& job) {
  for_each_batch(static_cast<int>(job.lit.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(enter_batch)(job, first, last);
  });
  job.inside.end();
  job.refracted.end();
}

}  // namespace heliograph::render::kernels
#endif
