#include "render/kernels/blend/blended.hpp"
#include "render/kernels/simd/rows.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/kernels/blend/blended_light.cpp"
#include "hwy/foreach_target.h"
// After the line above, which compiles this file once for each instruction set.
#include "render/kernels/blend/chosen_hit.hpp"
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/lights.hpp"
#include "render/kernels/simd/material/hit_material.hpp"
#include "render/kernels/simd/material/specular_lobe.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/tiles.hpp"
#include "shaders/shared/sampling.h"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

struct LightBatches {
  RayBatch shadows, ambient, specular;
};

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes.
template <class Surface>
class BlendedLight {
  using Material =
      std::conditional_t<Surface::layered, LayeredMaterial<Float>, SurfaceMaterial<Float>>;

 public:
  explicit BlendedLight(const BlendedLightJob& job)
      : job_(job),
        cone_(CameraLanes(job.frame).cone()),
        environment_(job.frame, job.lit_scene.environment),
        tables_(job.lit_scene.tables),
        picks_(unsigned_tag, job.frame.sample_index, 40u, job.frame.seed),
        rates_(unsigned_tag, job.frame.sample_index, 50u, job.frame.seed),
        sides_(unsigned_tag, job.frame.sample_index, shared::side_dimension, job.frame.seed),
        points_(unsigned_tag, job.frame.sample_index, 41u, job.frame.seed),
        around_(unsigned_tag, job.frame.sample_index, 42u, job.frame.seed),
        lobes_(unsigned_tag, job.frame.sample_index, 43u, job.frame.seed) {}

  void block(int first, int last, LightBatches& to) const {
    const RayLanes view = load_rays(job_.lit.rays, first, last);
    const PixelLanes pixel = unpack_pixel(view.pixel);
    const Mask lanes = float_mask(hn::Lt(hn::Iota(integer_tag, first), integer(last)));
    Float3 throughput;
    const HitLanes hit = chosen_hit(job_, pixel, lanes, throughput);
    const Float4 seen = gathered4(job_.transmittance, pixel);
    const Float width = hn::MulAdd(hit.t, number(cone_.y), number(cone_.x));
    const auto s = hit_surface<Surface, false>(job_.lit_scene.scene, hit, view.direction, width);
    const Material m = material_of(s, view.direction, tables_);
    const Float view_z = hn::Neg(transform_row(job_.frame.view, 2, s.position));
    RayLanes ray;
    ray.origin = offset_origin(s.position, m.geometric, view_z);
    ray.t_min = zero();
    ray.pixel = view.pixel;
    if (enabled(shared::frame_direct)) add_shadow(s, m, pixel, throughput, lanes, ray, to.shadows);
    const bool gathers = job_.constants.gathers != 0;
    Float3 around = numbers(0.0f);
    if (gathers) {
      around = wide_albedo(m);
    } else if (enabled(shared::frame_environment_diffuse)) {
      around = environment_diffuse(
          m, [&](const Float3& normal) HWY_ATTR { return environment_.irradiance(normal); });
    }
    const Float roughness = narrower_roughness(m);
    // Roughness is stored in steps of 1 / 255: a little more than half of one is still the same.
    const Mask traced =
        hn::And(lanes, hn::Le(roughness, number(job_.constants.max_roughness + 0.6f / 255.0f)));
    if (!none(traced)) {
      const Float rate = reflection_rate(roughness, s.metallic);
      add_specular(m, pixel, throughput, rate, traced, ray, to.specular);
    }
    if (gathers && !all(traced)) {
      around = select(traced, around, around + m.specular_albedo);
    } else if (enabled(shared::frame_environment_specular) && !all(traced)) {
      const Float3 light = environment_specular(m, [&](const Float3& normal, Float of) HWY_ATTR {
        return environment_.reflection(reflect(-m.eye, normal), of);
      });
      around = select(traced, around, around + light);
    }
    const Float occlusion = gathers ? one() : s.occlusion;
    Ambient ambient{m.normal, m.geometric, around};
    if (gathers && scatters_through(m)) {
      choose_side(m, pixel, ambient);
      ray.origin = offset_origin(s.position, ambient.geometric, view_z);
    }
    ambient.light = throughput * ambient.light * occlusion;
    add_ambient(ambient, pixel, lanes, ray, to.ambient);
    store(pixel, lanes, {seen.x, seen.y, seen.z, view_z},
          pack_unorm8({roughness, s.metallic, zero(), zero()}));
  }

 private:
  bool enabled(std::uint32_t flag) const { return (job_.frame.flags & flag) != 0; }

  /// Light of all lights times visibility, estimated with one ray to a randomly chosen light.
  HWY_INLINE void add_shadow(const Surface& s, const Material& m, const PixelLanes& pixel,
                             const Float3& throughput, Mask lanes, RayLanes ray,
                             RayBatch& to) const {
    const Unsigned x = as_unsigned(pixel.x), y = as_unsigned(pixel.y);
    Float pick = picks_.at(x, y);
    const LightChoice light =
        choose_light(job_.lit_scene.lights, job_.lit_scene.tables.ltc, m, s.position, lanes, pick);
    Mask valid = hn::And(lanes, hn::Gt(light.total, zero()));
    if (none(valid)) return;
    Float2 u;
    points_.at(x, y, u.x, u.y);
    const Mask seen = aim(job_.lit_scene.lights, light, m, s.position, u, pick, valid, ray);
    if (scatters_through(m)) {
      const Float view_z = hn::Neg(transform_row(job_.frame.view, 2, s.position));
      ray.origin = offset_origin(s.position, lit_side(m, ray.direction), view_z);
    }
    if (enabled(shared::frame_shadows)) {
      valid = seen;
    } else {
      ray.t_max = zero();
    }
    ray.user = throughput * light.sum;
    to.add(ray, valid);
  }

  /// Rough surfaces other than metals reflect little, and what they reflect is noisy anyhow.
  HWY_INLINE Float reflection_rate(Float roughness, Float metallic) const {
    const Mask mirrors = hn::Or(hn::Lt(roughness, number(shared::plan_smooth_roughness)),
                                hn::Gt(metallic, number(shared::plan_metallic)));
    return select(mirrors, one(), number(job_.constants.rough_rate));
  }

  HWY_INLINE void add_specular(const Material& m, const PixelLanes& pixel, const Float3& throughput,
                               Float rate, Mask lanes, RayLanes ray, RayBatch& to) const {
    const Unsigned x = as_unsigned(pixel.x), y = as_unsigned(pixel.y);
    lanes = hn::And(lanes, hn::Lt(rates_.at(x, y), rate));
    if (none(lanes)) return;
    Float2 u;
    lobes_.at(x, y, u.x, u.y);
    const SpecularSample drawn = sample_specular(m, u);
    ray.direction = drawn.direction;
    ray.t_max = number(1e30f);
    ray.user = throughput * drawn.weight * (one() / rate);
    to.add(ray, hn::And(lanes, hn::Gt(largest_of(drawn.weight), zero())));
  }

  /// A ray about `normal`: `light` comes along it, or is what the light that it gathers is
  /// multiplied by.
  struct Ambient {
    Float3 normal, geometric, light;
  };

  /// Light from both sides is gathered on one of them, in proportion to what reaches the eye.
  HWY_INLINE void choose_side(const Material& m, const PixelLanes& pixel, Ambient& ambient) const {
    const Float through = luminance(transmitted_albedo(m));
    const Float pick_behind = through / at_least(through + luminance(ambient.light), 1e-6f);
    const Float pick = sides_.at(as_unsigned(pixel.x), as_unsigned(pixel.y));
    const Mask behind = hn::Lt(pick, pick_behind);
    const Float near = at_least(one() - pick_behind, 1e-6f);
    const Float3 from_behind = transmitted_albedo(m) * (one() / at_least(pick_behind, 1e-6f));
    ambient.light = select(behind, from_behind, ambient.light * (one() / near));
    ambient.normal = select(behind, -m.normal, m.normal);
    ambient.geometric = select(behind, -m.geometric, m.geometric);
  }

  HWY_INLINE void add_ambient(const Ambient& ambient, const PixelLanes& pixel, Mask lanes,
                              RayLanes ray, RayBatch& to) const {
    const Float3& light = ambient.light;
    Float u, v;
    around_.at(as_unsigned(pixel.x), as_unsigned(pixel.y), u, v);
    ray.direction = sample_cosine(ambient.normal, u, v);
    const bool gathers = job_.constants.gathers != 0;
    const bool open = !gathers && !enabled(shared::frame_ambient_occlusion);
    ray.t_max = number(gathers ? 1e30f : open ? 0.0f : job_.frame.ambient_radius);
    ray.user = light;
    const auto differs = [](Float c) HWY_ATTR { return hn::Ne(c, zero()); };
    Mask valid =
        hn::And(lanes, hn::Or(differs(light.x), hn::Or(differs(light.y), differs(light.z))));
    if (!open) valid = hn::And(valid, hn::Gt(dot(ray.direction, ambient.geometric), zero()));
    to.add(ray, valid);
  }

  HWY_INLINE void store(const PixelLanes& pixel, Mask lanes, const Float4& behind,
                        Integer packed) const {
    const TexelIndices at(pixel);
    const Texels<4> transmittance(behind);
    const Texels<1> surface(as_float(packed));
    for_each_lane(lanes, [&](std::size_t lane) {
      transmittance.put(job_.transmittance, lane, at);
      surface.put(job_.surface, lane, at);
    });
  }

  const BlendedLightJob& job_;
  glm::vec2 cone_;
  EnvironmentLanes environment_;
  LobeLanes<Tag> tables_;
  RandomNumbers<UnsignedTag> picks_, rates_, sides_;
  RandomPairs<UnsignedTag> points_, around_, lobes_;
};

template <class Surface>
HWY_INLINE void light_batch_of(const BlendedLightJob& job, int first, int last) {
  const BlendedLight<Surface> light(job);
  LightBatches made;
  for (int i = first; i < last; i += static_cast<int>(hn::Lanes(tag))) light.block(i, last, made);
  made.shadows.append_to(job.shadows);
  made.ambient.append_to(job.ambient);
  made.specular.append_to(job.specular);
}

void light_batch(const BlendedLightJob& job, int first, int last) {
  if (job.lit_scene.layered) return light_batch_of<LayeredSurfaceLanes>(job, first, last);
  light_batch_of<SurfaceLanes>(job, first, last);
}

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heliograph::render::kernels {

HWY_EXPORT(light_batch);

void blended_light(const BlendedLightJob& job) {
  for_each_batch(static_cast<int>(job.lit.count->count), [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(light_batch)(job, first, last);
  });
  job.shadows.end();
  job.ambient.end();
  job.specular.end();
}

}  // namespace heliograph::render::kernels
#endif
