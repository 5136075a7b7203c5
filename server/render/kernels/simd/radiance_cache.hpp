// Looking up the radiance cache for hits, a lane for every ray:
// shaders/lib/lighting/radiance_cache.glsl and gathered_light.glsl. Included once per instruction
// set.
#if defined(HELIOGRAPH_KERNELS_RADIANCE_CACHE_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_RADIANCE_CACHE_HPP
#undef HELIOGRAPH_KERNELS_RADIANCE_CACHE_HPP
#else
#define HELIOGRAPH_KERNELS_RADIANCE_CACHE_HPP
#endif

#include "render/kernels/indirect/radiance_cache.hpp"
#include "render/kernels/simd/emissive_choice.hpp"
#include "render/kernels/simd/emissive_lights.hpp"
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/material/hit_material.hpp"
#include "render/kernels/simd/material/specular_lobe.hpp"
#include "render/kernels/simd/stored_triples.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// Irradiance / pi.
struct CachedLanes {
  Float3 direct, indirect;
  Float size;  // edge length of the cell, metres
  Mask known;
};

/// Where rays of length `t` have met `s`, on the side of `normal`. `order`: of the rays, one for
/// each.
template <class Surface>
HWY_INLINE CachedLanes cached_light(const CacheReader& cache, const Surface& s,
                                    const Float3& normal, Float t, Integer order, Mask requested,
                                    std::vector<CacheTouch>& touches) {
  const StoredTriples positions(s.position), normals(normal);
  const std::uint64_t backs = mask_bits(hn::Lt(dot(s.front, normal), zero()));
  const LaneIndices<Tag> orders(order);
  HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> lengths;
  hn::Store(t, tag, lengths.data());
  static_assert(hn::MaxLanes(Tag()) <= most_cache_queries);
  std::array<CacheQuery, hn::MaxLanes(Tag())> rays;
  std::array<CachedLight, hn::MaxLanes(Tag())> found;
  std::size_t count = 0;
  for_each_lane(requested, [&](std::size_t lane) {
    const SeenPlace at{positions.at(lane), normals.at(lane), (backs >> lane & 1) != 0};
    rays[count++] = {at, lengths[lane], static_cast<std::uint32_t>(orders.of[lane])};
  });
  cache.find({rays.data(), count}, found.data(), touches);
  StoredTriples direct(numbers(0.0f)), indirect(numbers(0.0f));
  HWY_ALIGN std::array<float, hn::MaxLanes(Tag())> sizes{};
  std::size_t next = 0;
  for_each_lane(requested, [&](std::size_t lane) {
    const CachedLight& light = found[next++];
    direct.put(lane, light.direct);
    indirect.put(lane, light.indirect);
    sizes[lane] = light.size;
  });
  const Float size = hn::Load(tag, sizes.data());
  return {direct.load(), indirect.load(), size, hn::Gt(size, zero())};
}

/// What surfaces send to the eye of indirect light. `open`: the environment's irradiance / pi.
template <class Material>
HWY_INLINE Float3 reflected_light(const Material& m, const Float3& irradiance, const Float3& open,
                                  const EnvironmentLanes& environment, std::uint32_t flags) {
  const Float sky = luminance(open);
  const Float share = luminance(irradiance) / at_least(sky, 1e-30f);
  const Float visible = hn::IfThenElseZero(hn::Gt(sky, zero()), hn::Min(share, one()));
  Float3 specular = m.specular_albedo * irradiance;
  if (flags & shared::frame_environment_specular) {
    const auto reflection = [&](const Float3& normal, Float roughness) HWY_ATTR {
      return environment.reflection(reflect(-m.eye, normal), roughness);
    };
    const Float3 rest = irradiance - open * visible;
    const Float3 elsewhere{at_least(rest.x, 0.0f), at_least(rest.y, 0.0f), at_least(rest.z, 0.0f)};
    specular = m.specular_albedo * elsewhere + environment_specular(m, reflection) * visible;
  }
  return wide_albedo(m) * irradiance + specular;
}

/// What rays that gather bring.
struct GatheredLanes {
  Float3 light;
  Mask known;
  Mask met;
  Float3 position, normal;  // geometric, of what they have met
};

/// The hits of rays that gather indirect light. `Job` has scene, environment, tables and cache.
template <class Surface, class Job>
class GatheredLight {
 public:
  GatheredLight(const Job& job, const CacheReader& cache)
      : job_(job), cache_(cache), environment_(job.frame, job.environment), tables_(job.tables) {}

  /// Radiance along the rays from `first` on. Probes ask for no cell.
  HWY_INLINE GatheredLanes block(int first, int last, const RayLanes& ray,
                                 std::vector<CacheTouch>& touches) const {
    const Mask requested = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    const HitLanes hit = load_hits(job_.hits, first, last);
    const Mask missed = hn::AndNot(hit.met, requested);
    Float3 light = numbers(0.0f);
    if (!none(missed) && enabled(shared::frame_environment_diffuse)) {
      light = environment_.radiance(ray.direction);
    }
    if (none(hit.met)) return {light, requested, hit.met, light, light};
    constexpr float spread = 0.25f;  // gathering_spread of gathered_light.glsl
    const auto s =
        hit_surface<Surface, true>(job_.scene, hit, ray.direction, hit.t * number(spread));
    const auto m = material_of(s, s.normal * number(-shared::mean_cosine), tables_);
    const Mask unlit = hn::And(hit.met, s.has(shared::material_unlit));
    const Mask probes = hn::Gt(ray.user.x, zero());
    const Mask lit = hn::AndNot(hn::Or(unlit, probes), hit.met);
    const CachedLanes cached = cached_light(cache_, s, s.geometric, hit.t, ray.pixel, lit, touches);
    Float3 sent = (wide_albedo(m) + m.specular_albedo) * (cached.direct + cached.indirect);
    Mask found = cached.known;
    const Mask through = hn::And(lit, hn::Gt(largest_of(transmitted_albedo(m)), zero()));
    if (scatters_through(m) && !none(through)) {
      const CachedLanes behind =
          cached_light(cache_, s, -s.geometric, hit.t, ray.pixel, through, touches);
      sent = sent + keep(through, transmitted_albedo(m) * (behind.direct + behind.indirect));
      found = hn::AndNot(hn::AndNot(behind.known, through), found);
    }
    sent = select(unlit, s.base_color, sent);
    if (enabled(shared::frame_emissive)) sent = sent + emission(ray, hit, s, lit);
    if constexpr (Surface::layered) sent = sent * (one() / (one() - s.passing));
    sent = select(is_bad(sent), numbers(0.0f), sent);
    light = select(hit.met, sent, light);
    const Mask known = hn::AndNot(hn::AndNot(found, lit), requested);
    return {light, known, hit.met, s.position, s.geometric};
  }

 private:
  bool enabled(std::uint32_t flag) const { return (job_.frame.flags & flag) != 0; }

  /// Less what shadow rays toward emissive triangles bring to `lit` lanes.
  HWY_INLINE Float3 emission(const RayLanes& ray, const HitLanes& hit, const Surface& s,
                             Mask lit) const {
    if (job_.scene.emissive.header->count == 0) return s.emissive;
    const Float cosine = dot(s.front, ray.direction);
    const Mask shines = hn::Or(hn::Le(cosine, zero()), s.has(shared::material_double_sided));
    const Float probability = emissive_probability(job_.scene, hit.instance, hit.triangle);
    const Float density = probability / at_least(s.area, 1e-30f);
    const Float sampled = density * hit.t * hit.t / at_least(hn::Abs(cosine), 1e-6f);
    const Float share = hn::IfThenElseZero(shines, gathered_share(ray.user.z, sampled));
    return s.emissive * select(lit, share, one());
  }

  const Job& job_;
  const CacheReader& cache_;
  EnvironmentLanes environment_;
  LobeLanes<Tag> tables_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
