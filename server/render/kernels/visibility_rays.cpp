#include "render/kernels/visibility_rays.hpp"

#include "render/kernels/common/tile.hpp"
#include "render/kernels/simd/rows.hpp"
#include "shaders/shared/sampling.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/visibility_rays.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/light_grid.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/rays.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// What both kinds of rays have in common: which pixels of a tile trace, and what the others hold.
template <class Maker, class Job>
class VisibilityRays {
 public:
  /// `bit`: of the plan's words.
  HWY_INLINE VisibilityRays(const Job& job, std::uint32_t bit)
      : job_(job), camera_(job.frame), bit_(static_cast<int>(bit)) {}

  /// `unseen`: visibility where there is no surface.
  HWY_INLINE void generate(const Tile& tile, float unseen) const {
    PixelList traced;
    for_each_row(tile, [&](const TileRow& row) {
      const Mask seen = hn::Gt(row_last(job_.motion, row), zero());
      const Mask sampled = is_sampled(row);
      traced.add(row.pixels, hn::And(row.inside, hn::And(seen, sampled)));
      const Float without_ray = hn::IfThenZeroElse(sampled, number(-1.0f));
      put_row(job_.visibility, row, select(seen, without_ray, number(unseen)));
    });
    RayBatch made;
    for (int i = 0; i < traced.size(); i += static_cast<int>(hn::Lanes(tag))) {
      Mask requested;
      const PixelLanes pixels = traced.from(i, requested);
      RayLanes ray;
      ray.t_min = zero();
      ray.pixel = pack_pixel(pixels);
      ray.user = numbers(0.0f);
      static_cast<const Maker*>(this)->make(pixels, ray, requested);
      put_values(job_.visibility, pixels, requested, one());
      made.add(ray, requested);
    }
    made.append_to(job_.rays);
  }

 protected:
  const Job& job_;
  CameraLanes camera_;

 private:
  int bit_;

  HWY_INLINE Mask is_sampled(const TileRow& row) const {
    if (job_.constants.by_plan == 0) return hn::Eq(zero(), zero());
    const Integer bit = hn::And(row_words(job_.planned, row), integer(bit_));
    return float_mask(hn::Ne(bit, integer(0)));
  }
};

template <bool layered>
class ShadowRays : public VisibilityRays<ShadowRays<layered>, ShadowRaysJob> {
  using Base = VisibilityRays<ShadowRays<layered>, ShadowRaysJob>;
  using Base::camera_;
  using Base::job_;

 public:
  HWY_INLINE explicit ShadowRays(const ShadowRaysJob& job)
      : Base(job, shared::plan_shadows),
        tables_(job.tables),
        picks_(unsigned_tag, job.frame.sample_index, 1u, job.frame.seed),
        points_(unsigned_tag, job.frame.sample_index, 2u, job.frame.seed),
        // As compose() does: the visibility is that of the light that it adds.
        entry_picks_(unsigned_tag, job.frame.sample_index, shared::light_picks_dimension,
                     job.frame.seed) {}

  HWY_INLINE void make(const PixelLanes& pixels, RayLanes& ray, Mask& requested) const {
    const Float view_z = gathered_last(job_.motion, pixels);
    const auto m = gbuffer_material<layered>(job_, pixels, camera_.to_eye(pixels), tables_);
    const Float3 position = camera_.world_position(pixels, view_z);
    const Unsigned x = as_unsigned(pixels.x), y = as_unsigned(pixels.y);
    Float pick = picks_.at(x, y);
    const Float entry_picks = job_.lights.grid ? entry_picks_.at(x, y) : zero();
    const LightChoice light =
        choose_light(job_.lights, job_.tables.ltc, m, position, requested, entry_picks, pick);
    Float2 u;
    points_.at(x, y, u.x, u.y);
    requested =
        aim(job_.lights.all, job_.lights.outside, light, m, position, u, pick, requested, ray);
    ray.origin = offset_origin(position, lit_side(m, ray.direction), view_z);
  }

 private:
  LobeLanes<Tag> tables_;
  RandomNumbers<UnsignedTag> picks_;
  RandomPairs<UnsignedTag> points_;
  RandomNumbers<UnsignedTag> entry_picks_;
};

class AmbientRays : public VisibilityRays<AmbientRays, AmbientRaysJob> {
 public:
  HWY_INLINE explicit AmbientRays(const AmbientRaysJob& job)
      : VisibilityRays(job, shared::plan_ambient),
        directions_(unsigned_tag, job.frame.sample_index, 3u, job.frame.seed) {}

  /// Directions below the surface are hidden by it.
  HWY_INLINE void make(const PixelLanes& pixels, RayLanes& ray, Mask& requested) const {
    const Float view_z = gathered_last(job_.motion, pixels);
    const Float4 encoded = gathered4(job_.normals, pixels);
    const Float3 geometric = octahedral_decode(encoded.z, encoded.w);
    Float u, v;
    directions_.at(as_unsigned(pixels.x), as_unsigned(pixels.y), u, v);
    ray.direction = sample_cosine(octahedral_decode(encoded.x, encoded.y), u, v);
    ray.origin = offset_origin(camera_.world_position(pixels, view_z), geometric, view_z);
    ray.t_max = number(job_.frame.ambient_radius);
    requested = hn::And(requested, hn::Gt(dot(ray.direction, geometric), zero()));
  }

 private:
  RandomPairs<UnsignedTag> directions_;
};

void shadow_ray_tile(const ShadowRaysJob& job, const Tile& tile) {
  if (job.layered) return ShadowRays<true>(job).generate(tile, 0.0f);
  ShadowRays<false>(job).generate(tile, 0.0f);
}

void ambient_ray_tile(const AmbientRaysJob& job, const Tile& tile) {
  AmbientRays(job).generate(tile, 1.0f);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(shadow_ray_tile);
HWY_EXPORT(ambient_ray_tile);

void shadows_rays(const ShadowRaysJob& job) {
  for_each_tile(job.width, job.rows.within(job.height), [&](const Tile& tile) {
    HWY_DYNAMIC_DISPATCH(shadow_ray_tile)(job, tile);
  });
  job.rays.end();
}

void ambient_rays(const AmbientRaysJob& job) {
  for_each_tile(job.width, job.rows.within(job.height), [&](const Tile& tile) {
    HWY_DYNAMIC_DISPATCH(ambient_ray_tile)(job, tile);
  });
  job.rays.end();
}

}  // namespace heliograph::render::kernels
#endif
