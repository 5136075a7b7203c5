// One blended surface more in pixels, from front to back: lay_over() of
// shaders/blend/blended_surfaces.comp in vectors. Included once per instruction set; the guard is
// Google Highway's convention.
#if defined(HELIOGRAPH_KERNELS_BLENDED_LAYER_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNELS_BLENDED_LAYER_HPP
#undef HELIOGRAPH_KERNELS_BLENDED_LAYER_HPP
#else
#define HELIOGRAPH_KERNELS_BLENDED_LAYER_HPP
#endif

#include "render/kernels/blend/blended.hpp"
#include "render/kernels/gbuffer/gbuffer_shading.hpp"
#include "render/kernels/simd/environment.hpp"
#include "render/kernels/simd/lights.hpp"
#include "render/kernels/simd/material/transmission.hpp"
#include "render/kernels/simd/random.hpp"
#include "render/kernels/simd/tiles.hpp"

HWY_BEFORE_NAMESPACE();
namespace heliograph::render::kernels::HWY_NAMESPACE {

/// What is known of pixels whose blended surfaces are laid over.
struct BlendedPixels {
  gpu::HostView radiance;       // rgba32f; a: sum of all weights
  gpu::HostView transmittance;  // rgba32f; a: weight of the chosen surface
  gpu::HostView front_motion;   // rgba32f
  shared::Hit* chosen;          // by pixel
};

/// `Surface`: SurfaceLanes, or LayeredSurfaceLanes. References outlive it.
template <class Surface>
class BlendedLayer {
  using Material =
      std::conditional_t<Surface::layered, LayeredMaterial<Float>, SurfaceMaterial<Float>>;

 public:
  /// Of the rounds in which rays meet one surface after the other, from 0 on.
  BlendedLayer(const shared::FrameConstants& frame, const LitScene& scene,
               const BlendedPixels& pixels, const GBufferShading<Surface>& shading,
               std::uint32_t round)
      : frame_(frame),
        scene_(scene),
        pixels_(pixels),
        shading_(shading),
        environment_(frame, scene.environment),
        tables_(scene.tables),
        picks_(unsigned_tag, frame.sample_index, 44u + round, frame.seed) {}

  /// What lay_over() finds besides.
  struct Found {
    Mask shows;      // anything behind still shows
    Mask first_lit;  // it is the first of its pixel to be lit
    Mask front;      // the pixel's motion is the surface's
  };

  HWY_INLINE Found lay_over(const PixelLanes& pixel, const HitRecords& records, const HitLanes& hit,
                            const Surface& s, const Float3& direction, Mask lanes) const {
    const Material m = material_of(s, direction, tables_);
    Float4 light = gathered4(pixels_.radiance, pixel);
    Float4 seen = gathered4(pixels_.transmittance, pixel);
    const Float3 before{seen.x, seen.y, seen.z}, throughput = before * s.alpha;
    const Mask unlit = s.has(shared::material_unlit);
    Float3 own = keep(unlit, s.base_color);
    if (enabled(shared::frame_emissive)) own = own + s.emissive;
    const Mask has_none = hn::Eq(light.w, zero()), lit = hn::AndNot(unlit, lanes);
    const Mask bends = bends_light(frame_, s, boundary_of(scene_.scene, hit, s, direction));
    if (!none(lit)) {
      choose(pixel, hit, open_light(s, m, lit, bends), throughput, lit, light.w, seen.w);
    }
    const Float open = one() - s.alpha;
    const Float3 after = before * select(bends, Float3{open, open, open}, seen_behind(s, m));
    const Float half = number(0.5f);
    Found found;
    found.first_lit = hn::And(lit, hn::And(has_none, hn::Gt(light.w, zero())));
    found.front =
        hn::And(lanes, hn::And(hn::Ge(luminance(before), half), hn::Lt(luminance(after), half)));
    const TexelIndices at(pixel);
    if (!none(found.front)) {
      const Float view_z = hn::Neg(transform_row(frame_.view, 2, s.position));
      const Texels<4> motion(shading_.motion(records.instance, hit, s, view_z));
      for_each_lane(found.front,
                    [&](std::size_t lane) { motion.put(pixels_.front_motion, lane, at); });
    }
    const Float3 sent = multiply_add(throughput, own, {light.x, light.y, light.z});
    const Texels<4> radiance(Float4{sent.x, sent.y, sent.z, light.w});
    const Texels<4> behind(Float4{after.x, after.y, after.z, seen.w});
    for_each_lane(lanes, [&](std::size_t lane) {
      radiance.put(pixels_.radiance, lane, at);
      behind.put(pixels_.transmittance, lane, at);
    });
    found.shows = hn::And(lanes, shows(after));
    return found;
  }

  /// Where anything shows behind what has been laid over.
  HWY_INLINE Mask shows_behind(const PixelLanes& pixel) const {
    const Float4 seen = gathered4(pixels_.transmittance, pixel);
    return shows({seen.x, seen.y, seen.z});
  }

 private:
  bool enabled(std::uint32_t flag) const { return (frame_.flags & flag) != 0; }

  static HWY_INLINE Mask shows(const Float3& transmittance) {
    constexpr float least_seen = 1.0f / 512.0f;  // less changes nothing
    return hn::Gt(largest_of(transmittance), number(least_seen));
  }

  /// As if nothing occluded it. `bends`: what is behind it shows along a ray of its own.
  HWY_INLINE Float3 open_light(const Surface& s, const Material& m, Mask lanes, Mask bends) const {
    Float3 sum = numbers(0.0f);
    if (enabled(shared::frame_direct)) {
      sum = direct_light(tag, scene_.lights, scene_.tables.ltc, m, s.position, lanes);
    }
    if (enabled(shared::frame_environment_diffuse)) {
      sum = sum + environment_diffuse(m, [&](const Float3& normal)
                                             HWY_ATTR { return environment_.irradiance(normal); });
    }
    if (enabled(shared::frame_environment_specular)) {
      sum = sum + environment_specular(m, [&](const Float3& normal, Float roughness) HWY_ATTR {
              return environment_.reflection(reflect(-m.eye, normal), roughness);
            });
    }
    if constexpr (Surface::layered) {
      if (none(bends)) return sum;
      sum = sum + keep(bends, m.transmitted * environment_.reflection(-m.eye, m.roughness));
    }
    return sum;
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
    const auto width = static_cast<int>(frame_.extent.x);
    for_each_lane(chosen, [&](std::size_t lane) {
      auto* const to =
          reinterpret_cast<std::byte*>(pixels_.chosen + (at.y[lane] * width + at.x[lane]));
      std::memcpy(to, &front.values[4 * lane], 16);
      std::memcpy(to + 16, &back.values[4 * lane], 16);
    });
  }

  const shared::FrameConstants& frame_;
  const LitScene& scene_;
  BlendedPixels pixels_;
  const GBufferShading<Surface>& shading_;
  EnvironmentLanes environment_;
  LobeLanes<Tag> tables_;
  RandomNumbers<UnsignedTag> picks_;
};

}  // namespace heliograph::render::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
