#include <bit>
#include <cmath>

#include "render/kernels/simd/rows.hpp"
#include "render/kernels/specular.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/specular_shade.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/specular_lobe.hpp"
#include "render/kernels/simd/surface.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// The hits of one job, some at a time.
class HitShading {
 public:
  explicit HitShading(const SpecularShadeJob& job)
      : job_(job),
        frame_(job.frame),
        cone_(CameraLanes(job.frame).cone()),
        environment_(job.frame, job.environment),
        split_sum_(job.split_sum.texels, job.split_sum.size),
        picks_(specular_numbers(job.frame, 5, job.constants.scale)),
        points_(specular_pairs(job.frame, 6, job.constants.scale)) {}

  /// @return how many shadow rays there are, which lie at `shadows`
  std::size_t block(int first, int last, shared::Ray* shadows) const {
    const Mask requested = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    const RayLanes ray = load_rays(job_.rays.rays, first, last);
    const PixelLanes pixel = unpack_pixel(ray.pixel);
    const PixelLanes cell = job_.constants.scale == 1 ? pixel
                                                      : PixelLanes{hn::ShiftRight<1>(pixel.x),
                                                                   hn::ShiftRight<1>(pixel.y)};
    const HitLanes hit = load_hits(job_.hits, first, last);
    const Mask missed = hn::AndNot(hit.met, requested);
    Float3 light = numbers(0.0f);
    Float travelled = number(distance_of_misses);
    if (!none(missed) && enabled(shared::frame_environment_specular)) {
      light = environment_.radiance(ray.direction);
    }
    std::size_t count = 0;
    if (!none(hit.met)) {
      travelled = select(hit.met, hn::Min(hit.t, travelled), travelled);
      const SurfaceLanes s =
          hit_surface<true>(job_.scene, hit, ray.direction, footprint(pixel, hit));
      const MaterialLanes m = make_material(tag, s.base_color, s.metallic, s.roughness, s.normal,
                                            s.geometric, -ray.direction, split_sum_);
      light = select(hit.met, steady_light(s, m), light);
      const Mask lit = hn::AndNot(s.has(shared::material_unlit), hit.met);
      if (job_.constants.lights && enabled(shared::frame_direct) && !none(lit)) {
        count = make_shadow_rays(ray, s, m, cell, lit, shadows);
      }
    }
    store(cell, scrubbed(light * ray.user), travelled, requested);
    return count;
  }

 private:
  static constexpr float distance_of_misses = 1e4f;  // metres

  bool enabled(std::uint32_t flag) const { return (frame_.flags & flag) != 0; }

  /// Widths of the camera's ray cones after reflection at the pixels' roughness.
  HWY_INLINE Float footprint(const PixelLanes& p, const HitLanes& hit) const {
    const auto pitch = [](const gpu::HostView& image) {
      return integer(static_cast<int>(image.row_pitch / sizeof(float)));
    };
    const Integer z = hn::Add(hn::Mul(p.y, pitch(job_.motion)), hn::ShiftLeft<2>(p.x));
    const Float view_z = gather(job_.motion.row<const float>(0), hn::Add(z, integer(3)));
    const Integer at = hn::Add(hn::Mul(p.y, pitch(job_.surface)), p.x);
    const Float roughness = unpack_unorm8(gather(job_.surface.data, at)).x;
    const Float spread = hn::MulAdd(number(0.5f) * roughness, roughness, number(cone_.y));
    const Float width = hn::MulAdd(number(cone_.y), view_z, number(cone_.x));
    return hn::MulAdd(spread, hit.t, width);
  }

  /// What of a hit's light needs no ray.
  HWY_INLINE Float3 steady_light(const SurfaceLanes& s, const MaterialLanes& m) const {
    Float3 light = numbers(0.0f);
    if (enabled(shared::frame_environment_diffuse)) {
      light = m.diffuse_albedo * environment_.irradiance(m.normal);
    }
    if (enabled(shared::frame_environment_specular)) {
      const Float3 reflected = reflect(-m.eye, m.normal);
      light =
          multiply_add(m.specular_albedo, environment_.reflection(reflected, m.roughness), light);
    }
    light = select(s.has(shared::material_unlit), s.base_color, light);
    return enabled(shared::frame_emissive) ? light + s.emissive : light;
  }

  /// One of the lights, in proportion to what it sends to the eye.
  struct Choice {
    Float total;   // of all; 0: there is none
    Float weight;  // luminance of its unshadowed contribution
    Float3 contribution;
    Float3 direction;
    Float distance;
    Float spread;  // tangent of its radius as seen from the hit
  };

  HWY_INLINE Choice choose_light(const MaterialLanes& m, const Float3& position, Mask requested,
                                 Float pick) const {
    Choice choice{zero(), one(), numbers(0.0f), numbers(glm::vec3(0.0f, 1.0f, 0.0f)),
                  one(),  zero()};
    for (const shared::Light& light : job_.lights) {
      const Mask near = reached(tag, light, position, requested);
      if (none(near)) continue;
      const LightSample<Float> s = light_at(tag, light, position);
      const Mask faces = hn::And(near, hn::Gt(dot(m.geometric, s.direction), zero()));
      if (none(faces)) continue;
      const Float3 sent = numbers(light.color) * s.attenuation * shade_light(tag, m, s.direction);
      const Float weight = hn::IfThenElseZero(faces, luminance(sent));
      const Mask shines = hn::Gt(weight, zero());
      choice.total = select(shines, choice.total + weight, choice.total);
      const Float probability = weight / select(shines, choice.total, one());
      const Mask chosen = hn::And(shines, hn::Lt(pick, probability));
      const Float remaining = (pick - probability) / (one() - probability);
      pick = select(chosen, pick / probability, select(shines, remaining, pick));
      choice.weight = select(chosen, weight, choice.weight);
      choice.contribution = select(chosen, sent, choice.contribution);
      choice.direction = select(chosen, s.direction, choice.direction);
      choice.distance = select(chosen, s.distance, choice.distance);
      const bool far = light.type == shared::light_directional;
      const Float radius = number(light.radius);
      choice.spread = select(chosen, far ? radius : radius / s.distance, choice.spread);
    }
    return choice;
  }

  HWY_INLINE std::size_t make_shadow_rays(const RayLanes& ray, const SurfaceLanes& s,
                                          const MaterialLanes& m, const PixelLanes& cell, Mask lit,
                                          shared::Ray* shadows) const {
    const Unsigned x = as_unsigned(cell.x), y = as_unsigned(cell.y);
    const Choice light = choose_light(m, s.position, lit, picks_.at(x, y));
    const Mask valid = hn::Gt(light.total, zero());
    if (none(valid)) return 0;
    // A point of the light's disk.
    Float2 u;
    points_.at(x, y, u.x, u.y);
    const Float2 disk = sample_disk(u.x, u.y);
    Float3 tangent, bitangent;
    orthonormal_basis(light.direction, tangent, bitangent);
    RayLanes shadow;
    shadow.direction =
        normalized(multiply_add(tangent, disk.x * light.spread,
                                multiply_add(bitangent, disk.y * light.spread, light.direction)));
    // The disk may reach below the horizon, where nothing of it is seen.
    const Mask above = hn::Gt(dot(shadow.direction, m.geometric), zero());
    shadow.origin = offset_origin(s.position, m.geometric, zero());
    shadow.t_min = zero();
    // Without shadows every light is visible: an empty interval hits nothing.
    shadow.t_max = enabled(shared::frame_shadows) ? light.distance * number(0.999f) : zero();
    shadow.pixel = ray.pixel;
    shadow.user = light.contribution * (light.total / light.weight) * ray.user;
    return store_rays(shadow, hn::And(valid, above), shadows);
  }

  static HWY_INLINE Float3 scrubbed(const Float3& v) { return select(is_bad(v), numbers(0.0f), v); }

  HWY_INLINE void store(const PixelLanes& cell, const Float3& light, Float travelled,
                        Mask requested) const {
    const Texels<4> texels(Float4{light.x, light.y, light.z, travelled});
    const TexelIndices indices(cell);
    for_each_lane(requested, [&](std::size_t lane) { texels.put(job_.radiance, lane, indices); });
  }

  const SpecularShadeJob& job_;
  const shared::FrameConstants& frame_;
  glm::vec2 cone_;
  EnvironmentLanes environment_;
  SquareTable<Tag> split_sum_;
  RandomNumbers<UnsignedTag> picks_;
  RandomPairs<UnsignedTag> points_;
};

void shade_hits_batch(const SpecularShadeJob& job, int first, int last) {
  const HitShading shading(job);
  std::array<shared::Ray, ray_batch> shadows;
  std::size_t count = 0;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) {
    count += shading.block(i, last, shadows.data() + count);
  }
  if (count) job.shadows.append({shadows.data(), count});
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(shade_hits_batch);

void specular_shade(const SpecularShadeJob& job) {
  for_each_batch(static_cast<int>(job.rays.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(shade_hits_batch)(job, first, last);
  });
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
