#include "render/kernels/blend/blended.hpp"
#include "render/kernels/indirect/radiance_cache.hpp"
#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_gather.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/radiance_cache.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// What a ray gathers where it meets what no cell knows: a part of the environment.
HWY_INLINE Float3 guessed(const EnvironmentLanes& environment, const RayLanes& ray) {
  return environment.irradiance(ray.direction) * number(shared::unknown_openness);
}

template <class Surface>
HWY_INLINE void gather_batch_of(const BlendedGatherJob& job, CacheReader& cache, int first,
                                int last) {
  const GatheredLight<Surface, BlendedGatherJob> gathered(job, cache);
  const EnvironmentLanes environment(job.frame, job.environment);
  std::vector<CacheTouch> touches;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    RayLanes ray = load_rays(job.rays.rays, i, last);
    const Float3 weight = ray.user;
    // All emission belongs to the ray: nothing else brings that of emissive triangles.
    ray.user = {zero(), one(), number(1e30f)};
    const GatheredLanes brought = gathered.block(i, last, ray, touches);
    const Float3 light = select(brought.known, brought.light, guessed(environment, ray)) * weight;
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    const Float4 sum = gathered4(job.radiance, pixel);
    const Mask bad = is_bad(light);
    const Float3 added = select(bad, numbers(0.0f), light);
    const Texels<4> texels(Float4{sum.x + added.x, sum.y + added.y, sum.z + added.z, sum.w});
    const TexelIndices at(pixel);
    const Mask requested = float_mask(hn::Lt(hn::Iota(integer_tag, i), integer(last)));
    for_each_lane(requested, [&](std::size_t lane) { texels.put(job.radiance, lane, at); });
  }
  cache.add(touches);
}

void gather_batch(const BlendedGatherJob& job, CacheReader& cache, int first, int last) {
  if (job.layered) return gather_batch_of<LayeredSurfaceLanes>(job, cache, first, last);
  gather_batch_of<SurfaceLanes>(job, cache, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(gather_batch);

void blended_gather(const BlendedGatherJob& job) {
  CacheReader cache(job.keys, job.cells, job.constants, job.frame.eye);
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(gather_batch)(job, cache, first, last);
  });
  cache.apply();
}

}  // namespace heliograph::render::kernels
#endif
