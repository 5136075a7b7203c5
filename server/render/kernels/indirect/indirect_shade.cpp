#include "render/kernels/indirect/radiance_cache.hpp"
#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/indirect/indirect_shade.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/radiance_cache.hpp"
#include "render/kernels/simd/tiles.hpp"
#include "render/kernels/simd/two_sided_light.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

HWY_INLINE void store_light(const IndirectShadeJob& job, const RayLanes& ray,
                            const GatheredLanes& gathered, Mask requested) {
  const Mask known = gathered.known;
  Float3 light = gathered.light * ray.user.y;
  if (!none(float_mask(hn::Ne(as_integer(ray.user.x), integer(0))))) {
    light = light * unpack_side_share(ray.user.x);
  }
  const Texels<4> texels(
      Float4{hn::IfThenElseZero(known, light.x), hn::IfThenElseZero(known, light.y),
             hn::IfThenElseZero(known, light.z), select(known, one(), number(-1.0f))});
  const TexelIndices indices(unpack_pixel(ray.pixel));
  for_each_lane(requested, [&](std::size_t lane) { texels.put(job.radiance, lane, indices); });
}

/// What cells do not know leaves their mean as it is. Probes that meet nothing have reached
/// the cell's new place.
HWY_INLINE void store_light(const RadianceCacheShadeJob& job, const RayLanes& ray,
                            const GatheredLanes& gathered, Mask requested) {
  const LaneIndices<Tag> slots(ray.pixel);
  const auto cell_of = [&](std::size_t lane) -> shared::RadianceCell& {
    return job.cells[slots.of[lane]];
  };
  const Mask probes = hn::And(hn::Gt(ray.user.x, zero()), requested);
  const StoredTriples values(gathered.light * ray.user.y);
  HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> luminances;
  hn::Store(luminance(gathered.light), tag, luminances.data());
  const std::uint64_t known = mask_bits(gathered.known);
  for_each_lane(hn::AndNot(probes, requested), [&](std::size_t lane) {
    shared::RadianceCell& cell = cell_of(lane);
    cell.gathered = luminances[lane];
    cell.new_indirect = known >> lane & 1 ? values.at(lane) : glm::vec3(shared::nothing_gathered);
  });
  if (none(probes)) return;
  const StoredTriples places(
      select(gathered.met, gathered.position, ray.origin + ray.direction * ray.t_max));
  const StoredTriples normals(gathered.normal);
  const std::uint64_t met = mask_bits(gathered.met);
  for_each_lane(probes, [&](std::size_t lane) {
    shared::RadianceCell& cell = cell_of(lane);
    cell.anchor = places.at(lane);
    if ((met >> lane & 1) == 0) return;
    cell.new_direct = normals.at(lane);
    cell.state = shared::cell_blocked;
  });
}

template <class Surface, class Job>
HWY_INLINE void shade_gathered(const Job& job, CacheReader& cache, int first, int last) {
  const GatheredLight<Surface, Job> gathered(job, cache);
  std::vector<CacheTouch> touches;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    const RayLanes ray = load_rays(job.rays.rays, i, last);
    store_light(job, ray, gathered.block(i, last, ray, touches),
                float_mask(hn::Lt(hn::Iota(integer_tag, i), integer(last))));
  }
  cache.add(touches);
}

template <class Job>
HWY_INLINE void shade_batch(const Job& job, CacheReader& cache, int first, int last) {
  if (job.layered) return shade_gathered<LayeredSurfaceLanes>(job, cache, first, last);
  shade_gathered<SurfaceLanes>(job, cache, first, last);
}

void indirect_shade_batch(const IndirectShadeJob& job, CacheReader& cache, int first, int last) {
  shade_batch(job, cache, first, last);
}

void cache_shade_batch(const RadianceCacheShadeJob& job, CacheReader& cache, int first, int last) {
  shade_batch(job, cache, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(indirect_shade_batch);
HWY_EXPORT(cache_shade_batch);

void indirect_shade(const IndirectShadeJob& job) {
  CacheReader cache(job.keys, job.cells, job.constants, job.frame.eye);
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(indirect_shade_batch)(job, cache, first, last);
  });
  cache.apply();
}

void radiance_cache_shade(const RadianceCacheShadeJob& job) {
  CacheReader cache(job.keys, job.cells, job.constants, job.frame.eye);
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(cache_shade_batch)(job, cache, first, last);
  });
  cache.apply();
}

}  // namespace heliograph::render::kernels
#endif
