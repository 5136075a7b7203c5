#include <cstring>

#include "render/kernels/blend/blended.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_surfaces.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/gbuffer/gbuffer_shading.hpp"
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/lights.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes.
template <class Surface>
class BlendedHits {
  using Material =
      std::conditional_t<Surface::layered, LayeredMaterial<Float>, SurfaceMaterial<Float>>;

 public:
  explicit BlendedHits(const BlendedSurfacesJob& job)
      : job_(job),
        shading_(job.frame, job.scene, job.deforms),
        environment_(job.frame, job.environment),
        tables_(job.tables),
        picks_(unsigned_tag, job.frame.sample_index, 44u + job.constants.round, job.frame.seed) {}

  /// Rays that go on lie at `passed`, those whose pixel has a surface to light at `lit`.
  void block(int first, int last, shared::Ray* passed, std::size_t& passed_count, shared::Ray* lit,
             std::size_t& lit_count) const {
    const HitLanes hit = load_hits(job_.hits, first, last);
    if (none(hit.met)) return;
    RayLanes ray = load_rays(job_.met.rays, first, last);
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    HitRecords records(job_.scene, hit);
    records.triangle.set_point(hit.u, hit.v);
    const Surface s = shading_.surface(records, hit, ray.direction);
    const Mask open = hn::And(hit.met, is_open(s, ray.direction));
    const Mask blended = hn::AndNot(open, hn::And(hit.met, is_blended(s)));
    Mask goes_on = open;
    if (!none(blended)) {
      Mask first_lit;
      goes_on =
          hn::Or(goes_on, lay_over(pixel, records, hit, s, ray.direction, blended, first_lit));
      lit_count += store_rays(ray, first_lit, lit + lit_count);
    }
    if (job_.constants.last_round || none(goes_on)) return;
    ray.t_min = GBufferShading<Surface>::passed_from(hit.t);
    passed_count += store_rays(ray, goes_on, passed + passed_count);
  }

 private:
  bool enabled(std::uint32_t flag) const { return (job_.frame.flags & flag) != 0; }

  /// As if nothing occluded it.
  HWY_INLINE Float3 open_light(const Surface& s, const Material& m, Mask lanes) const {
    Float3 sum = numbers(0.0f);
    if (enabled(shared::frame_direct)) {
      sum = direct_light(tag, job_.lights, job_.tables.ltc, m, s.position, lanes);
    }
    if (enabled(shared::frame_environment_diffuse)) {
      sum = sum + wide_albedo(m) * environment_.irradiance(m.normal);
    }
    if (enabled(shared::frame_environment_specular)) {
      sum = sum + environment_specular(m, [&](const Float3& normal, Float roughness) HWY_ATTR {
              return environment_.reflection(reflect(-m.eye, normal), roughness);
            });
    }
    return sum;
  }

  /// @return where anything behind still shows. `first_lit`: where it is the first of its pixel to
  /// be lit.
  HWY_INLINE Mask lay_over(const PixelLanes& pixel, const HitRecords& records, const HitLanes& hit,
                           const Surface& s, const Float3& direction, Mask lanes,
                           Mask& first_lit) const {
    const Material m = material_of(s, direction, tables_);
    Float4 light = gathered4(job_.radiance, pixel), seen = gathered4(job_.transmittance, pixel);
    const Float3 before{seen.x, seen.y, seen.z}, throughput = before * s.alpha;
    const Mask unlit = s.has(shared::material_unlit);
    Float3 own = keep(unlit, s.base_color);
    if (enabled(shared::frame_emissive)) own = own + s.emissive;
    const Mask has_none = hn::Eq(light.w, zero()), lit = hn::AndNot(unlit, lanes);
    if (!none(lit)) choose(pixel, hit, open_light(s, m, lit), throughput, lit, light.w, seen.w);
    first_lit = hn::And(lit, hn::And(has_none, hn::Gt(light.w, zero())));
    const Float3 after = before * seen_behind(s, m);
    const Float half = number(0.5f);
    const Mask front =
        hn::And(lanes, hn::And(hn::Ge(luminance(before), half), hn::Lt(luminance(after), half)));
    const TexelIndices at(pixel);
    if (!none(front)) {
      const Float view_z = hn::Neg(transform_row(job_.frame.view, 2, s.position));
      const Texels<4> motion(shading_.motion(records.instance, hit, s, view_z));
      for_each_lane(front, [&](std::size_t lane) { motion.put(job_.front_motion, lane, at); });
    }
    const Float3 sent = multiply_add(throughput, own, {light.x, light.y, light.z});
    const Texels<4> radiance(Float4{sent.x, sent.y, sent.z, light.w});
    const Texels<4> behind(Float4{after.x, after.y, after.z, seen.w});
    for_each_lane(lanes, [&](std::size_t lane) {
      radiance.put(job_.radiance, lane, at);
      behind.put(job_.transmittance, lane, at);
    });
    constexpr float least_seen = 1.0f / 512.0f;  // less changes nothing
    return hn::And(lanes, hn::Gt(largest_of(after), number(least_seen)));
  }

  /// `throughput` of `open` reaches the eye. The chosen hit carries it.
  HWY_INLINE void choose(const PixelLanes& pixel, const HitLanes& hit, const Float3& open,
                         const Float3& throughput, Mask lanes, Float& total, Float& weight) const {
    // Never 0: reflections may show what emits where the environment does not.
    const Float own =
        hn::MulAdd(number(1e-3f), luminance(throughput), luminance(throughput * open));
    const Mask shines = hn::And(lanes, hn::Gt(own, zero()));
    total = total + hn::IfThenElseZero(shines, own);
    const Float pick = picks_.at(as_unsigned(pixel.x), as_unsigned(pixel.y));
    const Mask chosen = hn::And(shines, hn::Lt(pick * total, own));
    if (none(chosen)) return;
    weight = select(chosen, own, weight);
    static_assert(sizeof(shared::Hit) == 32 && offsetof(shared::Hit, padding0) == 20);
    const Texels<4> front(Float4{hit.t, as_float(hit.instance), as_float(hit.triangle), hit.u});
    const Texels<4> back(Float4{hit.v, throughput.x, throughput.y, throughput.z});
    const TexelIndices at(pixel);
    const auto width = static_cast<int>(job_.frame.extent.x);
    for_each_lane(chosen, [&](std::size_t lane) {
      auto* const to =
          reinterpret_cast<std::byte*>(job_.chosen + (at.y[lane] * width + at.x[lane]));
      std::memcpy(to, &front.values[4 * lane], 16);
      std::memcpy(to + 16, &back.values[4 * lane], 16);
    });
  }

  /// The factor on what is seen through the surface.
  static HWY_INLINE Float3 seen_behind(const Surface& s, const Material& m) {
    const Float open = one() - s.alpha;
    if constexpr (Surface::layered) {
      return multiply_add(m.transmitted, s.alpha, {open, open, open});
    } else {
      return {open, open, open};
    }
  }

  const BlendedSurfacesJob& job_;
  GBufferShading<Surface> shading_;
  EnvironmentLanes environment_;
  LobeLanes<Tag> tables_;
  RandomNumbers<UnsignedTag> picks_;
};

template <class Surface>
HWY_INLINE void blended_batch_of(const BlendedSurfacesJob& job, int first, int last) {
  const BlendedHits<Surface> surfaces(job);
  std::array<shared::Ray, ray_batch> passed, lit;
  std::size_t passed_count = 0, lit_count = 0;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    surfaces.block(i, last, passed.data(), passed_count, lit.data(), lit_count);
  }
  if (passed_count) job.rays.append({passed.data(), passed_count});
  if (lit_count) job.lit.append({lit.data(), lit_count});
}

void blended_batch(const BlendedSurfacesJob& job, int first, int last) {
  if (job.layered) return blended_batch_of<LayeredSurfaceLanes>(job, first, last);
  blended_batch_of<SurfaceLanes>(job, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(blended_batch);

void blended_surfaces(const BlendedSurfacesJob& job) {
  for_each_batch(static_cast<int>(job.met.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(blended_batch)(job, first, last);
  });
  job.rays.end();
  job.lit.end();
}

}  // namespace heliograph::render::kernels
#endif
