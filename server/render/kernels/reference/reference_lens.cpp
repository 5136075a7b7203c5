#include "render/kernels/reference/reference.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/reference/reference_lens.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/ray_writer.hpp"
#include "render/kernels/simd/rays.hpp"
#include "render/kernels/simd/stored_triples.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

void spread_batch(const ReferenceLensJob& job, int first, int last) {
  const shared::FrameConstants& frame = job.frame;
  const RandomPairs<UnsignedTag> random(unsigned_tag, frame.sample_index, shared::lens_dimension,
                                        frame.seed);
  const Float3 right = numbers(glm::vec3(frame.inverse_view[0]));
  const Float3 up = numbers(glm::vec3(frame.inverse_view[1]));
  const Float3 forward = numbers(-glm::vec3(frame.inverse_view[2]));
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    const RayLanes ray = load_rays(job.rays, i, last);
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    Float2 u;
    random.at(as_unsigned(pixel.x), as_unsigned(pixel.y), u.x, u.y);
    const Float2 at = sample_disk(u.x, u.y);
    const Float3 shift = (right * at.x + up * at.y) * number(frame.lens_radius);
    const Float3 in_focus =
        ray.direction * (number(frame.focus_distance) / dot(ray.direction, forward));
    const StoredTriples origins(ray.origin + shift), directions(normalized(in_focus - shift));
    const Mask requested = hn::And(float_mask(hn::Lt(hn::Iota(integer_tag, i), integer(last))),
                                   hn::Lt(ray.t_min, ray.t_max));
    for_each_lane(requested, [&](std::size_t lane) {
      shared::Ray& out = job.rays[i + static_cast<int>(lane)];
      out.origin = origins.at(lane);
      out.direction = directions.at(lane);
    });
  }
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(spread_batch);

void reference_lens(const ReferenceLensJob& job) {
  if (job.frame.lens_radius <= 0.0f) return;
  for_each_batch(static_cast<int>(job.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(spread_batch)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
