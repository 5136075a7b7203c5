#include "render/kernels/blend/blended.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_refract.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/material/transmission.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Rays at the next boundary of their volumes. Materials have layers.
class BoundaryCrossing {
 public:
  explicit BoundaryCrossing(const BlendedRefractJob& job)
      : job_(job),
        scene_(job.lit_scene.scene),
        cone_(CameraLanes(job.frame).cone()),
        tables_(job.lit_scene.tables),
        bands_(job.frame),
        picks_(unsigned_tag, job.frame.sample_index, dimension(job), job.frame.seed),
        directions_(unsigned_tag, job.frame.sample_index, dimension(job) + 1, job.frame.seed) {}

  void block(int first, int last, RayBatch& inside, RayBatch& refracted) const {
    RayLanes ray = load_rays(job_.inside.rays, first, last);
    const Mask lanes = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    const HitLanes hit = load_hits(job_.hits, first, last);
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    const Integer across = integer(static_cast<int>(job_.frame.extent.x));
    const Records entered(job_.chosen, hn::Add(hn::Mul(pixel.y, across), pixel.x),
                          sizeof(shared::Hit) / 4);
    const Integer instance = entered.whole(HELIOGRAPH_WORD(shared::Hit, instance));
    const Integer medium = layer_number(scene_, instance);
    // The mesh is not closed: as if its volume were as thick as the material says.
    Float3 left = left_by_thickness(scene_, instance, medium);
    const Integer band = bands_.at(scene_, medium, pixel);
    Mask stays = hn::FirstN(tag, 0);
    if (!none(hit.met)) {
      left = select(hit.met, left_by_volume(scene_, medium, hit.t), left);
      const Float from_eye = entered.real(HELIOGRAPH_WORD(shared::Hit, t)) + hit.t;
      stays = cross(hit, from_eye, band, pixel, ray);
    }
    ray.user = ray.user * left;
    // Neighbours are to see that nothing is left of a band.
    const Mask banded = float_mask(hn::Gt(band, integer(0)));
    const Mask carries = hn::And(lanes, hn::Or(banded, hn::Gt(largest_of(ray.user), zero())));
    inside.add(ray, hn::And(carries, stays));
    refracted.add(ray, hn::AndNot(stays, carries));
  }

 private:
  static std::uint32_t dimension(const BlendedRefractJob& job) {
    return shared::boundary_dimension + 2 * job.constants.round;
  }

  /// `band`: that rays have in the volumes that they have entered. @return which stay inside
  HWY_INLINE Mask cross(const HitLanes& hit, Float from_eye, Integer band, const PixelLanes& pixel,
                        RayLanes& ray) const {
    const Mask nowhere = hn::FirstN(tag, 0);
    const Float width = hn::MulAdd(from_eye, number(cone_.y), number(cone_.x));
    const auto s = hit_surface<LayeredSurfaceLanes, false>(scene_, hit, ray.direction, width);
    const BoundaryLanes boundary = boundary_of(scene_, hit, s, ray.direction);
    const Mask leaving = boundary.leaving;
    if (none(leaving)) return nowhere;
    const LayeredMaterial<Float> m = material_of(s, ray.direction, tables_);
    const Unsigned x = as_unsigned(pixel.x), y = as_unsigned(pixel.y);
    Float2 u;
    directions_.at(x, y, u.x, u.y);
    const Float index = refraction_index(scene_, boundary.medium, band);
    const DepartureLanes d = sample_departure(s, m, index, picks_.at(x, y), u);
    ray.user = select(leaving, ray.user * d.weight, ray.user);
    // After the last boundary all light goes on as if nothing bent it.
    const Mask stays = job_.constants.last_round ? nowhere : hn::AndNot(d.outside, leaving);
    const Mask turns = hn::And(leaving, hn::Or(d.outside, stays));
    ray.direction = select(turns, d.direction, ray.direction);
    const Float3 side = select(stays, s.geometric, -s.geometric);
    ray.origin = select(leaving, offset_origin(s.position, side, zero()), ray.origin);
    return stays;
  }

  const BlendedRefractJob& job_;
  const SceneView& scene_;
  glm::vec2 cone_;
  LobeLanes<Tag> tables_;
  PixelBands bands_;
  RandomNumbers<UnsignedTag> picks_;
  RandomPairs<UnsignedTag> directions_;
};

void refract_batch(const BlendedRefractJob& job, int first, int last) {
  const BoundaryCrossing crossing(job);
  RayBatch inside, refracted;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    crossing.block(i, last, inside, refracted);
  }
  inside.append_to(job.next);
  refracted.append_to(job.refracted);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(refract_batch);

void blended_refract(const BlendedRefractJob& job) {
  for_each_batch(static_cast<int>(job.inside.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(refract_batch)(job, first, last);
  });
  job.next.end();
  job.refracted.end();
}

}  // namespace heliograph::render::kernels
#endif
