#include <numbers>

#include "render/kernels/common/tile.hpp"
#include "render/kernels/simd/rows.hpp"
#include "render/kernels/specular.hpp"
#include "shaders/shared/sampling.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/specular_rays.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/material/specular_lobe.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

template <bool layered>
class Generation {
 public:
  explicit Generation(const SpecularRaysJob& job)
      : job_(job),
        frame_(job.frame),
        camera_(job.frame),
        tables_(job.tables),
        environment_(job.frame, job.environment),
        scale_(job.directions ? 2 : 1),
        random_(specular_pairs(job.frame, 4, scale_)) {}

  /// Clears the cells; lists those whose rays are to be made.
  HWY_INLINE void clear(const TileRow& cells, PixelList& traced) const {
    const Mask seen = hn::Gt(view_z(cells), zero());
    Mask sampled = seen;
    Float4 radiance{zero(), zero(), zero(), zero()};
    if (job_.constants.by_plan != 0) {
      const Integer word = plan_words(cells);
      const Integer bit = hn::And(word, integer(static_cast<int>(shared::plan_specular)));
      sampled = hn::And(seen, float_mask(hn::Ne(bit, integer(0))));
      // A negative distance: no sample, and how far it was in the frame before.
      const Float before = as_float(hn::ShiftLeft<16>(word));
      const Float away = hn::Min(hn::Neg(before), number(-1e-6f));
      radiance.w = hn::IfThenElseZero(hn::AndNot(sampled, seen), away);
    }
    put_row(job_.radiance, cells, radiance);
    if (job_.directions) put_row(job_.directions, cells, Float4{zero(), zero(), zero(), zero()});
    traced.add(cells.pixels, hn::And(cells.inside, sampled));
  }

  HWY_INLINE void block(const PixelLanes& cell, Mask inside, RayBatch& made) const {
    const PixelLanes pixel = traced_pixel(cell);
    const Float view_z = gathered_last(job_.motion, pixel);
    const Float4 packed = gathered_unorm8(job_.surface, pixel);
    const Mask lit = hn::And(inside, hn::Le(packed.z, number(0.5f)));  // not unlit
    if (none(lit)) return;

    const auto m = gbuffer_material<layered>(job_, pixel, camera_.to_eye(pixel), tables_);
    // Roughness is stored in steps of 1 / 255: a little more than half of one is still the same.
    const Mask smooth =
        hn::Le(narrower_roughness(m), number(job_.constants.max_roughness + 0.6f / 255.0f));
    const Mask requested =
        hn::AndNot(look_up(cell, pixel, m, hn::And(lit, smooth)), hn::And(lit, smooth));
    if (none(requested)) return;
    Float2 u;
    random_.at(as_unsigned(cell.x), as_unsigned(cell.y), u.x, u.y);
    const SpecularSample s = sample_specular(m, u);
    const Float3& albedo = m.specular_albedo;
    RayLanes ray;
    ray.user = {s.weight.x / at_least(albedo.x, 1e-3f), s.weight.y / at_least(albedo.y, 1e-3f),
                s.weight.z / at_least(albedo.z, 1e-3f)};
    const auto positive = [](Float v) { return hn::Gt(v, zero()); };
    const Mask valid =
        hn::Or(positive(ray.user.x), hn::Or(positive(ray.user.y), positive(ray.user.z)));
    if (job_.directions) {
      put_directions(cell, s, requested);
      ray.user = numbers(1.0f);
    }
    ray.origin = offset_origin(camera_.world_position(pixel, view_z), m.geometric, view_z);
    ray.direction = s.direction;
    ray.t_min = zero();
    ray.t_max = number(1e30f);
    ray.pixel = pack_pixel(pixel);
    made.add(ray, hn::And(requested, valid));
  }

 private:
  /// Looks the environment up for those of `candidates` whose words say so. @return which
  template <class Material>
  HWY_INLINE Mask look_up(const PixelLanes& cell, const PixelLanes& pixel, const Material& m,
                          Mask candidates) const {
    if (job_.constants.by_plan == 0) return hn::FirstN(tag, 0);
    const Integer word = gather(job_.planned.data, texel_index(job_.planned, pixel, 1));
    const Integer bit = hn::And(word, integer(static_cast<int>(shared::plan_environment)));
    const Mask chosen = hn::And(candidates, float_mask(hn::Ne(bit, integer(0))));
    if (none(chosen)) return chosen;
    const Float3 seen = expected_reflection(m, ambient_before(word));
    const Float before = as_float(hn::ShiftLeft<16>(word));
    const Float away = select(hn::Gt(before, zero()), before, number(distance_of_misses));
    const Float3 clean = select(is_bad(seen), numbers(0.0f), seen);
    const Texels<4> texels(Float4{clean.x, clean.y, clean.z, away});
    const TexelIndices indices(cell);
    for_each_lane(chosen, [&](std::size_t lane) { texels.put(job_.radiance, lane, indices); });
    return chosen;
  }

  HWY_INLINE Float ambient_before(Integer word) const {
    if (!shared::traces_ambient(frame_.flags)) return one();
    const Unsigned steps = hn::ShiftRight<shared::plan_visibility_shift>(as_unsigned(word));
    return to_float(as_integer(steps)) / number(shared::plan_visibility_steps);
  }

  /// expected_reflection() of shaders/lib/lighting/environment.glsl
  template <class Material>
  HWY_INLINE Float3 expected_reflection(const Material& m, Float ambient) const {
    Float3 open = numbers(0.0f), occluded = numbers(0.0f);
    if (frame_.flags & shared::frame_environment_specular) {
      const auto reflection = [&](const Float3& normal, Float roughness) HWY_ATTR {
        return environment_.reflection(reflect(-m.eye, normal), roughness);
      };
      const Float3 light = environment_specular(m, reflection);
      const Float3& albedo = m.specular_albedo;
      open = {light.x / at_least(albedo.x, 1e-3f), light.y / at_least(albedo.y, 1e-3f),
              light.z / at_least(albedo.z, 1e-3f)};
    }
    if (frame_.flags & shared::frame_environment_diffuse) {
      occluded =
          environment_.irradiance(reflect(m.eye, m.normal)) * number(shared::expected_albedo);
    }
    return mix(occluded, open, specular_occlusion(m.n_dot_v, ambient, m.roughness));
  }

  static HWY_INLINE Float specular_occlusion(Float n_dot_v, Float visibility, Float roughness) {
    const Float exponent = hn::MulAdd(roughness * roughness, number(-16.0f), number(-1.0f));
    const Float power = hn::Exp(tag, exponent * number(std::numbers::ln2_v<float>));
    const Float raised = hn::Exp(tag, hn::Log(tag, n_dot_v + visibility) * power);
    return clamped(raised - one() + visibility, 0.0f, 1.0f);
  }

  HWY_INLINE Float view_z(const TileRow& cells) const {
    if (scale_ == 1) return row_last(job_.motion, cells);
    return gathered_last(job_.motion, traced_pixel(cells.pixels));
  }

  HWY_INLINE Integer plan_words(const TileRow& cells) const {
    if (scale_ == 1) return row_words(job_.planned, cells);
    return gather(job_.planned.data, texel_index(job_.planned, traced_pixel(cells.pixels), 1));
  }

  /// The pixel that traces for a cell: of 2 x 2 another in every frame.
  HWY_INLINE PixelLanes traced_pixel(const PixelLanes& cell) const {
    if (scale_ == 1) return cell;
    const std::uint32_t phase = frame_.sample_index & 3u;
    const auto within = [&](Integer c, std::uint32_t step, std::uint32_t size) {
      const Integer at = hn::Add(hn::Add(c, c), integer(static_cast<int>(step)));
      return hn::Min(at, integer(static_cast<int>(size) - 1));
    };
    return {within(cell.x, (phase ^ (phase >> 1u)) & 1u, frame_.extent.x),
            within(cell.y, phase & 1u, frame_.extent.y)};
  }

  HWY_INLINE void put_directions(const PixelLanes& cell, const SpecularSample& s,
                                 Mask requested) const {
    const Texels<4> texels(Float4{s.direction.x, s.direction.y, s.direction.z, s.density});
    const TexelIndices indices(cell);
    for_each_lane(requested, [&](std::size_t lane) { texels.put(job_.directions, lane, indices); });
  }

  const SpecularRaysJob& job_;
  const shared::FrameConstants& frame_;
  CameraLanes camera_;
  LobeLanes<Tag> tables_;
  EnvironmentLanes environment_;
  int scale_;
  RandomPairs<UnsignedTag> random_;
};

template <bool layered>
HWY_INLINE void make_tile_of(const SpecularRaysJob& job, const Tile& tile) {
  const Generation<layered> generation(job);
  PixelList traced;
  for_each_row(tile, [&](const TileRow& cells) { generation.clear(cells, traced); });
  RayBatch made;
  for (int i = 0; i < traced.size(); i += static_cast<int>(hn::Lanes(tag))) {
    Mask valid;
    const PixelLanes cells = traced.from(i, valid);
    generation.block(cells, valid, made);
  }
  made.append_to(job.rays);
}

void make_tile(const SpecularRaysJob& job, const Tile& tile) {
  if (job.layered) return make_tile_of<true>(job, tile);
  make_tile_of<false>(job, tile);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(make_tile);

void specular_rays(const SpecularRaysJob& job) {
  const int scale = job.directions ? 2 : 1;
  const auto cells = [scale](std::uint32_t size) {
    return (static_cast<int>(size) + scale - 1) / scale;
  };
  const Rows rows = job.rows.within(cells(job.frame.extent.y));
  for_each_tile(cells(job.frame.extent.x), rows, [&](const Tile& tile) {
    HWY_DYNAMIC_DISPATCH(make_tile)(job, tile);
  });
  job.rays.end();
}

}  // namespace heliograph::render::kernels
#endif
