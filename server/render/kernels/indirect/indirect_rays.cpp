#include "render/kernels/indirect/path_guide.hpp"
#include "render/kernels/indirect/radiance_cache.hpp"
#include "render/kernels/simd/rows.hpp"
#include "shaders/shared/sampling.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/indirect/indirect_rays.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/emissive_choice.hpp"
#include "render/kernels/simd/gathering_rays.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/stored_triples.hpp"
#include "render/kernels/simd/tiles.hpp"
#include "render/kernels/simd/two_sided_light.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

class IndirectRays {
 public:
  explicit IndirectRays(const IndirectRaysJob& job)
      : job_(job),
        camera_(job.frame),
        tables_(job.tables),
        sides_(unsigned_tag, job.frame.sample_index, shared::side_dimension, job.frame.seed),
        directions_(unsigned_tag, job.frame.sample_index, 3u, job.frame.seed) {}

  HWY_INLINE void generate(const Tile& tile) const {
    PixelList traced;
    for_each_row(tile, [&](const TileRow& row) {
      const Mask seen = hn::Gt(row_last(job_.motion, row), zero());
      const Mask sampled = is_sampled(row);
      traced.add(row.pixels, hn::And(row.inside, hn::And(seen, sampled)));
      const Mask left_out = hn::AndNot(sampled, seen);
      put_row(job_.radiance, row,
              Float4{zero(), zero(), zero(), select(left_out, number(-1.0f), one())});
    });
    RayBatch made;
    for (int i = 0; i < traced.size(); i += static_cast<int>(hn::Lanes(tag))) {
      Mask requested;
      const PixelLanes pixels = traced.from(i, requested);
      const RayLanes ray = ray_of(pixels);
      made.add(ray, requested);
    }
    made.append_to(job_.rays);
  }

 private:
  HWY_INLINE Mask is_sampled(const TileRow& row) const {
    if (job_.constants.by_plan == 0) return hn::Eq(zero(), zero());
    const Integer bit = hn::And(row_words(job_.planned, row), integer(shared::plan_ambient));
    return float_mask(hn::Ne(bit, integer(0)));
  }

  /// Directions below the surface, which a shading normal allows, are turned up: none is lost.
  HWY_INLINE RayLanes ray_of(const PixelLanes& pixels) const {
    const Float view_z = gathered_last(job_.motion, pixels);
    const Float4 encoded = gathered4(job_.normals, pixels);
    Float3 geometric = octahedral_decode(encoded.z, encoded.w);
    Float3 shading = octahedral_decode(encoded.x, encoded.y);
    Float share = zero(), side_weight = one();
    if (job_.both_sides) choose_side(pixels, shading, geometric, share, side_weight);
    Float u, v;
    directions_.at(as_unsigned(pixels.x), as_unsigned(pixels.y), u, v);
    RayLanes ray;
    const Float3 position = camera_.world_position(pixels, view_z);
    Float weight = one();
    if (job_.constants.guided != 0) guide(position, geometric, u, v, weight);
    ray.direction = sample_cosine_by_axis(shading, u, v);
    ray.origin = offset_origin(position, geometric, view_z);
    ray.t_min = zero();
    ray.t_max = number(1e30f);
    ray.pixel = pack_pixel(pixels);
    const Float below = hn::Min(dot(ray.direction, geometric), zero());
    ray.direction = multiply_add(geometric, below * number(-2.0f), ray.direction);
    const Float density = cosine_density(at_least(dot(ray.direction, shading), 0.0f));
    ray.user = {share, weight * side_weight, density};
    return ray;
  }

  /// Turns the normals of pixels that scatter light through to the side that their rays leave to.
  /// `share`: what the light is multiplied by, packed.
  HWY_INLINE void choose_side(const PixelLanes& pixels, Float3& shading, Float3& geometric,
                              Float& share, Float& weight) const {
    Mask through = hn::Gt(gathered_unorm8(job_.surface, pixels).w, zero());
    if (none(through)) return;
    const auto m = gbuffer_material<true>(job_, pixels, camera_.to_eye(pixels), tables_);
    through = hn::And(through, hn::Gt(largest_of(transmitted_albedo(m)), zero()));
    const SideShares shares = side_shares(m);
    const Float pick = sides_.at(as_unsigned(pixels.x), as_unsigned(pixels.y));
    const Mask behind = hn::And(through, hn::Lt(pick, shares.pick_behind));
    shading = select(behind, -shading, shading);
    geometric = select(behind, -geometric, geometric);
    const Float probability = select(behind, shares.pick_behind, one() - shares.pick_behind);
    weight = select(through, one() / at_least(probability, 1e-6f), one());
    share =
        hn::IfThenElseZero(through, pack_side_share(select(behind, shares.behind, shares.near)));
  }

  HWY_INLINE void guide(const Float3& position, const Float3& normal, Float& u, Float& v,
                        Float& weight) const {
    const IndirectRaysConstants& c = job_.constants;
    const CellScale scale{job_.frame.eye, c.cell_angle, c.least_size};
    const StoredTriples positions(position), normals(normal);
    StoredTriples drawn(Float3{u, v, weight});
    for (std::size_t lane = 0; lane < hn::Lanes(tag); ++lane) {
      const glm::vec2 pair(drawn.at(lane));
      const GuidedPair made =
          guided_pair(job_.guide.data, scale, positions.at(lane), normals.at(lane), pair);
      drawn.put(lane, {made.u, made.weight});
    }
    const Float3 guided = drawn.load();
    u = guided.x, v = guided.y, weight = guided.z;
  }

  const IndirectRaysJob& job_;
  CameraLanes camera_;
  LobeLanes<Tag> tables_;
  RandomNumbers<UnsignedTag> sides_;
  RandomPairs<UnsignedTag> directions_;
};

void indirect_ray_tile(const IndirectRaysJob& job, const Tile& tile) {
  IndirectRays(job).generate(tile);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(indirect_ray_tile);

void indirect_rays(const IndirectRaysJob& job) {
  for_each_tile(job.width, job.rows.within(job.height), [&](const Tile& tile) {
    HWY_DYNAMIC_DISPATCH(indirect_ray_tile)(job, tile);
  });
  job.rays.end();
}

}  // namespace heliograph::render::kernels
#endif
