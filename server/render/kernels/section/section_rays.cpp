#include "render/kernels/section/section.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/section/section_rays.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/ray_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// As kept_interval() in shaders/lib/rays/section.glsl.
HWY_INLINE Pair<Float> kept_interval(const shared::SectionConstants& section, const RayLanes& ray) {
  const Float origin = zero(), nothing = number(-shared::section_never);
  Pair<Float> kept{origin, number(shared::section_never)};
  for (std::uint32_t i = 0; i < section.count; ++i) {
    const glm::vec4& plane = section.planes[i];
    const Float3 normal{number(plane.x), number(plane.y), number(plane.z)};
    const Float above = dot(normal, ray.origin) - number(plane.w);
    const Float rise = dot(normal, ray.direction);
    const Float at = hn::Neg(above / rise);
    const Mask falls = hn::Lt(rise, origin), rises = hn::Lt(origin, rise);
    kept.x = hn::IfThenElse(falls, hn::Max(kept.x, at), kept.x);
    kept.y = hn::IfThenElse(rises, hn::Min(kept.y, at), kept.y);
    const Mask along = hn::AndNot(hn::Or(falls, rises), hn::Lt(origin, above));
    kept.y = hn::IfThenElse(along, nothing, kept.y);
  }
  return kept;
}

void cut_batch(const SectionRaysJob& job, int first, int last) {
  HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> from, to;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    const RayLanes ray = load_rays(job.rays, i, last);
    const Pair<Float> kept = kept_interval(job.constants, ray);
    const Float t_min = hn::Max(kept.x, ray.t_min), t_max = hn::Min(kept.y, ray.t_max);
    const Mask cut_away = hn::Ge(t_min, t_max);
    hn::Store(hn::IfThenElse(cut_away, number(shared::section_never), t_min), tag, from.data());
    hn::Store(hn::IfThenElse(cut_away, number(2.0f * shared::section_never), t_max), tag,
              to.data());
    const Mask requested = hn::And(float_mask(hn::Lt(hn::Iota(integer_tag, i), integer(last))),
                                   hn::Lt(ray.t_min, ray.t_max));
    for_each_lane(requested, [&](std::size_t lane) {
      shared::Ray& out = job.rays[i + static_cast<int>(lane)];
      out.t_min = from[lane];
      out.t_max = to[lane];
    });
  }
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(cut_batch);

void section_rays(const SectionRaysJob& job) {
  for_each_batch(static_cast<int>(job.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(cut_batch)(job, first, last);
  });
}

}  // namespace heliograph::render::kernels
#endif
