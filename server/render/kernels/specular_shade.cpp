#include <bit>
#include <cmath>

#include "render/kernels/simd/rows.hpp"
#include "render/kernels/specular.hpp"
#include "shaders/shared/sampling.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/specular_shade.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/light_grid.hpp"
#include "render/kernels/simd/material/hit_material.hpp"
#include "render/kernels/simd/material/specular_lobe.hpp"
#include "render/kernels/simd/radiance_cache.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// The hits of one job, some at a time. `Surface`: SurfaceLanes, or LayeredSurfaceLanes.
template <class Surface>
class HitShading {
  using Material =
      std::conditional_t<Surface::layered, LayeredMaterial<Float>, SurfaceMaterial<Float>>;

 public:
  HitShading(const SpecularShadeJob& job, CacheReader* cache)
      : job_(job),
        cache_(cache),
        frame_(job.frame),
        cone_(CameraLanes(job.frame).cone()),
        environment_(job.frame, job.environment),
        tables_(job.tables),
        picks_(specular_numbers(job.frame, 5, job.constants.scale)),
        points_(specular_pairs(job.frame, 6, job.constants.scale)),
        entry_picks_(
            specular_numbers(job.frame, shared::light_picks_dimension, job.constants.scale)) {}

  /// @return how many shadow rays there are, which lie at `shadows`
  std::size_t block(int first, int last, shared::Ray* shadows) {
    const Mask requested = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    const RayLanes ray = load_rays(job_.rays.rays, first, last);
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    const PixelLanes cell = job_.constants.scale == 1 ? pixel
                                                      : PixelLanes{hn::ShiftRight<1>(pixel.x),
                                                                   hn::ShiftRight<1>(pixel.y)};
    const HitLanes hit = load_hits(job_.hits, first, last);
    const Mask missed = hn::AndNot(hit.met, requested);
    Float3 light = numbers(0.0f), weight = ray.user;
    Float travelled = number(distance_of_misses);
    if (!none(missed) && enabled(shared::frame_environment_specular)) {
      light = environment_.radiance(ray.direction);
    }
    std::size_t count = 0;
    if (!none(hit.met)) {
      travelled = select(hit.met, hn::Min(hit.t, number(farthest_hit)), travelled);
      const Float roughness = reflector_roughness(pixel);
      const Float width = footprint(pixel, hit, roughness);
      const auto s = hit_surface<Surface, true>(job_.scene, hit, ray.direction, width);
      const Material m = material_of(s, ray.direction, tables_);
      if constexpr (Surface::layered) {
        // Rays stop where it covers, less those that its own colour would let through.
        weight = weight * select(hit.met, one() / (one() - s.passing), one());
      }
      Mask lit = hn::AndNot(s.has(shared::material_unlit), hit.met);
      light = select(hit.met, steady_light(s, m, hit.t, roughness, ray.pixel, lit), light);
      if (job_.constants.lights && enabled(shared::frame_direct) && !none(lit)) {
        count = add_lights(ray, weight, s.position, m, cell, lit, shown_shadows(hit, s, lit), light,
                           shadows);
      }
    }
    store(cell, scrubbed(light * weight), travelled, requested);
    return count;
  }

  /// What the cache is to make, after the last block.
  std::span<const CacheTouch> touches() const { return touches_; }

 private:
  bool enabled(std::uint32_t flag) const { return (frame_.flags & flag) != 0; }

  /// Of rows, in 32-bit words.
  static HWY_INLINE Integer texel_pitch(const gpu::HostView& image) {
    return integer(static_cast<int>(image.row_pitch / sizeof(float)));
  }

  HWY_INLINE Float reflector_roughness(const PixelLanes& p) const {
    const Integer at = hn::Add(hn::Mul(p.y, texel_pitch(job_.surface)), p.x);
    return unpack_unorm8(gather(job_.surface.data, at)).x;
  }

  /// Widths of the camera's ray cones after reflection at surfaces of this roughness.
  HWY_INLINE Float footprint(const PixelLanes& p, const HitLanes& hit, Float roughness) const {
    const Integer z = hn::Add(hn::Mul(p.y, texel_pitch(job_.motion)), hn::ShiftLeft<2>(p.x));
    const Float view_z = gather(job_.motion.row<const float>(0), hn::Add(z, integer(3)));
    const Float spread = hn::MulAdd(number(0.5f) * roughness, roughness, number(cone_.y));
    const Float width = hn::MulAdd(number(cone_.y), view_z, number(cone_.x));
    return hn::MulAdd(spread, hit.t, width);
  }

  /// What of a hit's light needs no ray. Hits whose light of lights is in it are no longer `lit`.
  HWY_INLINE Float3 steady_light(const Surface& s, const Material& m, Float t, Float roughness,
                                 Integer order, Mask& lit) {
    Float3 light = numbers(0.0f);
    if (!none(lit)) light = cache_ ? gathered_light(s, m, t, roughness, order, lit) : open_light(m);
    light = select(s.has(shared::material_unlit), s.base_color, light);
    return enabled(shared::frame_emissive) ? light + s.emissive : light;
  }

  HWY_INLINE Float3 gathered_light(const Surface& s, const Material& m, Float t, Float roughness,
                                   Integer order, Mask& lit) {
    const bool diffuse = enabled(shared::frame_environment_diffuse);
    const Float3 open = diffuse ? environment_.irradiance(m.normal) : numbers(0.0f);
    const CachedLanes cached = cached_light(*cache_, s, s.geometric, t, order, lit, touches_);
    const Float3 irradiance =
        select(cached.known, cached.indirect, open * number(shared::unknown_openness));
    Float3 light = reflected_light(m, irradiance, open, environment_, frame_.flags);
    Float3 direct = (wide_albedo(m) + m.specular_albedo) * cached.direct;
    Mask known = cached.known;
    const Mask through = hn::And(lit, hn::Gt(largest_of(transmitted_albedo(m)), zero()));
    if (scatters_through(m) && !none(through)) {
      const CachedLanes behind =
          cached_light(*cache_, s, -s.geometric, t, order, through, touches_);
      const Float3 sky = diffuse ? environment_.irradiance(-m.normal) : numbers(0.0f);
      const Float3 arriving =
          select(behind.known, behind.indirect, sky * number(shared::unknown_openness));
      light = light + keep(through, transmitted_albedo(m) * arriving);
      direct = direct + keep(through, transmitted_albedo(m) * behind.direct);
      known = hn::AndNot(hn::AndNot(behind.known, through), known);
    }
    if (!job_.constants.cached_lights) return light;
    // A mirror would show the cell.
    const Float lobe = roughness * roughness * t * number(shared::cell_in_lobe);
    const Mask by_cell = hn::And(known, hn::Lt(cached.size, lobe));
    lit = hn::AndNot(by_cell, lit);
    return light + keep(by_cell, direct);
  }

  /// The environment's light as if nothing hid it.
  HWY_INLINE Float3 open_light(const Material& m) const {
    Float3 light = numbers(0.0f);
    if (enabled(shared::frame_environment_diffuse)) {
      light = environment_diffuse(
          m, [&](const Float3& normal) HWY_ATTR { return environment_.irradiance(normal); });
    }
    if (enabled(shared::frame_environment_specular)) {
      const auto reflection = [&](const Float3& normal, Float roughness) HWY_ATTR {
        return environment_.reflection(reflect(-m.eye, normal), roughness);
      };
      light = light + environment_specular(m, reflection);
    }
    return light;
  }

  /// Fraction of the lights' radiance that the frame before saw arrive at hits, below 0 where it
  /// did not show them.
  HWY_INLINE Float shown_shadows(const HitLanes& hit, const Surface& s, Mask lit) const {
    const Float unknown = number(-1.0f);
    if (!job_.constants.reuse_shadows) return unknown;
    const Float half_w = number(0.5f) / transform_row(frame_.previous_unjittered, 3, s.position);
    const auto along = [&](int row, std::uint32_t size) HWY_ATTR {
      const Float clip = transform_row(frame_.previous_unjittered, row, s.position);
      return hn::MulAdd(clip, half_w, number(0.5f)) * number(static_cast<float>(size));
    };
    const Float x = along(0, frame_.extent.x), y = along(1, frame_.extent.y);
    const Float view_z = hn::Neg(transform_row(frame_.previous_view, 2, s.position));
    const glm::vec4 axis = frame_.inverse_view[2], eye = frame_.inverse_view[3];
    const Float3 to_eye = enabled(shared::frame_orthographic)
                              ? numbers(glm::vec3(axis))
                              : numbers(glm::vec3(eye)) - s.position;
    const auto within = [](Float v, std::uint32_t size) HWY_ATTR {
      return hn::And(hn::Ge(v, zero()), hn::Lt(v, number(static_cast<float>(size))));
    };
    Mask shown = hn::And(lit, hn::Gt(hn::Min(view_z, dot(s.geometric, to_eye)), zero()));
    shown = hn::And(shown, hn::And(within(x, frame_.extent.x), within(y, frame_.extent.y)));
    if (none(shown)) return unknown;
    const PixelLanes at{truncated(hn::IfThenElseZero(shown, x)),
                        truncated(hn::IfThenElseZero(shown, y))};
    const Integer instance =
        gather(job_.previous_instance.data, texel_index(job_.previous_instance, at, 1));
    const Float shown_z = gathered_last(job_.previous_motion, at);
    shown = hn::And(shown, float_mask(hn::Eq(instance, hn::Add(hit.instance, integer(1)))));
    shown = hn::And(
        shown, hn::Le(hn::Abs(shown_z - view_z), view_z * number(shared::shown_depth_tolerance)));
    const Float arrived = gathered_fraction(job_.visibility, at);
    return select(shown, arrived, unknown);
  }

  /// Adds the light of lights to `light` where their shadows are `shown`; elsewhere makes rays that
  /// carry it. @return how many
  HWY_INLINE std::size_t add_lights(const RayLanes& ray, const Float3& weight,
                                    const Float3& position, const Material& m,
                                    const PixelLanes& cell, Mask lit, Float shown, Float3& light,
                                    shared::Ray* shadows) const {
    const Unsigned x = as_unsigned(cell.x), y = as_unsigned(cell.y);
    Float pick = picks_.at(x, y);
    const Float entry_picks = job_.lights.grid ? entry_picks_.at(x, y) : zero();
    const LightChoice chosen =
        choose_light(job_.lights, job_.tables.ltc, m, position, lit, entry_picks, pick);
    const Mask known = hn::Ge(shown, zero());
    light = light + keep(known, chosen.sum * shown);
    const Mask valid = hn::AndNot(known, hn::And(lit, hn::Gt(chosen.total, zero())));
    if (none(valid)) return 0;
    Float2 u;
    points_.at(x, y, u.x, u.y);
    RayLanes shadow;
    const Mask seen =
        aim(job_.lights.all, job_.lights.outside, chosen, m, position, u, pick, valid, shadow);
    shadow.origin = offset_origin(position, lit_side(m, shadow.direction), zero());
    shadow.t_min = zero();
    // Without shadows every light is visible: an empty interval hits nothing.
    if (!enabled(shared::frame_shadows)) shadow.t_max = zero();
    shadow.pixel = ray.pixel;
    shadow.user = chosen.contribution * (chosen.total / chosen.weight) * weight;
    return store_rays(shadow, seen, shadows);
  }

  static HWY_INLINE Float3 scrubbed(const Float3& v) { return select(is_bad(v), numbers(0.0f), v); }

  HWY_INLINE void store(const PixelLanes& cell, const Float3& light, Float travelled,
                        Mask requested) const {
    const Texels<4> texels(Float4{light.x, light.y, light.z, travelled});
    const TexelIndices indices(cell);
    for_each_lane(requested, [&](std::size_t lane) { texels.put(job_.radiance, lane, indices); });
  }

  const SpecularShadeJob& job_;
  CacheReader* cache_;  // or null
  std::vector<CacheTouch> touches_;
  const shared::FrameConstants& frame_;
  glm::vec2 cone_;
  EnvironmentLanes environment_;
  LobeLanes<Tag> tables_;
  RandomNumbers<UnsignedTag> picks_;
  RandomPairs<UnsignedTag> points_;
  RandomNumbers<UnsignedTag> entry_picks_;
};

template <class Surface>
HWY_INLINE void shade_hits_of(const SpecularShadeJob& job, CacheReader* cache, int first,
                              int last) {
  HitShading<Surface> shading(job, cache);
  std::array<shared::Ray, ray_batch> shadows;
  std::size_t count = 0;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    count += shading.block(i, last, shadows.data() + count);
  }
  if (count) job.shadows.append({shadows.data(), count});
  if (cache) cache->add(shading.touches());
}

void shade_hits_batch(const SpecularShadeJob& job, CacheReader* cache, int first, int last) {
  if (job.layered) return shade_hits_of<LayeredSurfaceLanes>(job, cache, first, last);
  shade_hits_of<SurfaceLanes>(job, cache, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(shade_hits_batch);

void specular_shade(const SpecularShadeJob& job) {
  CacheReader cache(job.cache_keys, job.cache_cells, job.constants.cache, job.frame.eye);
  CacheReader* const read = job.cache_keys ? &cache : nullptr;
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(shade_hits_batch)(job, read, first, last);
  });
  cache.apply();
  job.shadows.end();
}

void specular_resolve(const SpecularResolveJob& job) {
  const auto scale = static_cast<std::uint32_t>(job.constants.scale);
  const auto carried = [](std::uint32_t bits) { return std::bit_cast<float>(bits); };
  for_each_batch(static_cast<int>(job.shadows.count->count), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const shared::Ray& ray = job.shadows.rays[i];
      const glm::vec3 light(carried(ray.user), carried(ray.padding0), carried(ray.padding1));
      if (job.occluded[i] || !std::isfinite(light.x + light.y + light.z)) continue;
      const std::uint32_t x = (ray.pixel & 0xffffu) / scale;
      const std::uint32_t y = (ray.pixel >> 16u) / scale;
      float* const texel = job.radiance.row<float>(y) + 4 * x;
      for (int c = 0; c < 3; ++c) texel[c] += light[c];
    }
  });
}

}  // namespace heliograph::render::kernels
#endif
