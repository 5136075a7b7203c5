#include "render/kernels/blend/blended.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_through.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/material/specular_lobe.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

void through_batch(const BlendedThroughJob& job, int first, int last) {
  const shared::FrameConstants& frame = job.frame;
  const bool visible = (frame.flags & shared::frame_environment_visible) != 0;
  const Texels<4> empty(Float4{zero(), zero(), zero(), zero()});
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    const RayLanes ray = load_rays(job.rays.rays, i, last);
    const Mask lanes = float_mask(hn::Lt(hn::Iota(integer_tag, i), integer(last)));
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    const Float4 met = gathered4(job.specular, pixel);
    const Mask missed = hn::Ge(met.w, number(distance_of_misses));
    Float3 light{met.x, met.y, met.z};
    if (!none(missed)) {
      Float3 behind = numbers(0.0f);
      if (visible) {
        behind = ray.user *
                 radiance_from(job.background, frame, ray.direction, frame.background_intensity);
      }
      light = select(missed, behind, light);
    }
    light = select(is_bad(light), numbers(0.0f), light);
    const TexelIndices at(pixel);
    if (job.constants.leaves) {
      const Texels<4> left(Float4{light.x, light.y, light.z, met.w});
      for_each_lane(lanes, [&](std::size_t lane) { left.put(job.specular, lane, at); });
      continue;
    }
    const Float4 sum = gathered4(job.radiance, pixel);
    const Texels<4> texels(Float4{sum.x + light.x, sum.y + light.y, sum.z + light.z, sum.w});
    for_each_lane(lanes, [&](std::size_t lane) {
      texels.put(job.radiance, lane, at);
      empty.put(job.specular, lane, at);
    });
  }
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(through_batch);

void blended_through(const BlendedThroughJob& job) {
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(through_batch)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
