#include "render/kernels/lights/emissive_points.hpp"
#include "render/kernels/simd/rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/lights/indirect_lights.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/emissive_choice.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/rays.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

class IndirectLights {
 public:
  explicit IndirectLights(const IndirectLightsJob& job)
      : job_(job),
        camera_(job.frame),
        tables_(job.tables),
        numbers_(unsigned_tag, job.frame.sample_index, 8u, job.frame.seed) {}

  HWY_INLINE void generate(const Tile& tile) const {
    PixelList lit;
    for_each_row(tile, [&](const TileRow& row) {
      const Mask seen = hn::Gt(row_last(job_.motion, row), zero());
      const Mask gathered = hn::Ge(row_last(job_.radiance, row), zero());
      lit.add(row.pixels, hn::And(row.inside, hn::And(seen, gathered)));
    });
    RayBatch made;
    for (int i = 0; i < lit.size(); i += static_cast<int>(hn::Lanes(tag))) {
      Mask requested;
      const PixelLanes pixels = lit.from(i, requested);
      const RayLanes ray = ray_of(pixels, requested);
      made.add(ray, requested);
    }
    made.append_to(job_.rays);
  }

 private:
  HWY_INLINE RayLanes ray_of(const PixelLanes& pixels, Mask& requested) const {
    const Float view_z = gathered_last(job_.motion, pixels);
    const Float4 encoded = gathered4(job_.normals, pixels);
    const Float3 geometric = octahedral_decode(encoded.z, encoded.w);
    const Float3 position = camera_.world_position(pixels, view_z);
    Float start, pick;
    numbers_.at(as_unsigned(pixels.x), as_unsigned(pixels.y), start, pick);
    const Float3 normal = octahedral_decode(encoded.x, encoded.y);
    Mask through = both_sided(pixels);
    EmissiveChoice choice;
    Float3 side = geometric;
    if (none(through)) {
      choice = choose_emissive(job_.points, position, normal, geometric, start, pick);
    } else {
      const SideShares shares = shares_of(pixels, through);
      choice = choose_emissive(job_.points, position, normal, geometric, start, pick, &shares);
      const Mask behind = hn::And(through, hn::Lt(dot(geometric, choice.direction), zero()));
      side = select(behind, -geometric, geometric);
    }
    requested = hn::And(requested, hn::Gt(choice.total, zero()));
    RayLanes ray;
    ray.direction = choice.direction;
    ray.origin = offset_origin(position, side, view_z);
    ray.t_min = zero();
    ray.t_max = choice.distance * number(0.999f);
    ray.pixel = pack_pixel(pixels);
    ray.user = choice.light;
    return ray;
  }

  HWY_INLINE Mask both_sided(const PixelLanes& pixels) const {
    if (!job_.both_sides) return hn::Lt(one(), zero());
    return hn::Gt(gathered_unorm8(job_.surface, pixels).w, zero());
  }

  /// Factors on the light of each side; others than `through` get all from one. Leaves there those
  /// whose light comes through.
  HWY_INLINE SideShares shares_of(const PixelLanes& pixels, Mask& through) const {
    const auto m = gbuffer_material<true>(job_, pixels, camera_.to_eye(pixels), tables_);
    through = hn::And(through, hn::Gt(largest_of(transmitted_albedo(m)), zero()));
    SideShares shares = side_shares(m);
    shares.near = select(through, shares.near, numbers(1.0f));
    shares.behind = keep(through, shares.behind);
    return shares;
  }

  const IndirectLightsJob& job_;
  CameraLanes camera_;
  LobeLanes<Tag> tables_;
  RandomPairs<UnsignedTag> numbers_;
};

void indirect_light_tile(const IndirectLightsJob& job, const Tile& tile) {
  IndirectLights(job).generate(tile);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(indirect_light_tile);

void indirect_lights(const IndirectLightsJob& job) {
  for_each_tile(job.width, job.rows.within(job.height), [&](const Tile& tile) {
    HWY_DYNAMIC_DISPATCH(indirect_light_tile)(job, tile);
  });
  job.rays.end();
}

}  // namespace heliograph::render::kernels
#endif
