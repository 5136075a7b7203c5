#include "render/passes/blend/blend_surfaces.hpp"

#include "render/kernels/blend/blended.hpp"
#include "render/passes/compose/skybox.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/reflections/trace_specular.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/transmission.h"

namespace heliograph::render {
namespace {

using formats::four_floats;
using formats::storage;

/// Grows `region` by the pixels that a box may cover.
void include(glm::uvec4& region, const scene::Bounds& bounds, const shared::FrameConstants& frame) {
  const glm::vec2 size(frame.extent);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec4 point(corner & 1 ? bounds.maximum.x : bounds.minimum.x,
                          corner & 2 ? bounds.maximum.y : bounds.minimum.y,
                          corner & 4 ? bounds.maximum.z : bounds.minimum.z, 1.0f);
    const glm::vec4 clip = frame.view_projection * point;
    if (clip.w <= 0.0f) {
      region = {0, 0, frame.extent.x, frame.extent.y};
      return;
    }
    const glm::vec2 at = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * size;
    const glm::uvec2 first(glm::clamp(glm::floor(at), glm::vec2(0.0f), size));
    const glm::uvec2 last(glm::clamp(glm::floor(at) + 1.0f, glm::vec2(0.0f), size));
    region = glm::uvec4(glm::min(glm::uvec2(region), first),
                        glm::max(glm::uvec2(region.z, region.w), last));
  }
}

/// The pixels that blended surfaces may cover: the first, and the one after the last.
glm::uvec4 blended_region(const FrameInputs& in) {
  glm::uvec4 region(in.constants.extent, 0, 0);
  for (const Draw& draw : in.moving.draws()) {
    const std::uint32_t flags = in.scene.scene->materials[draw.material].flags;
    if (flags & shared::material_alpha_blend) include(region, draw.bounds, in.constants);
  }
  return region;
}

class BlendedSurfaces {
 public:
  BlendedSurfaces(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                  const BlendedImages& images, const std::optional<RadianceCache>& cache)
      : plan_(plan),
        in_(in),
        gbuffer_(gbuffer),
        to_(images),
        cache_(cache),
        pixels_(plan.extent().width * plan.extent().height),
        lit_(declare_rays(plan, "blended.lit", pixels_, tracing::RayKind::camera)) {}

  /// From front to back, the light that the surfaces emit and their transmittance.
  void find() {
    tracing::RayStream current = declare_rays(plan_, "blended", pixels_, tracing::RayKind::camera);
    tracing::RayStream next =
        declare_rays(plan_, "blended.next", pixels_, tracing::RayKind::camera);
    const gpu::BufferRef hits =
        plan_.buffer("blended.hits", sizeof(shared::Hit) * pixels_, storage, gpu::Memory::device);
    begin_rays(plan_, in_, "blended", current, Blending::stops);
    begin_rays(plan_, in_, "blended.lit", lit_, Blending::stops);
    plan_.pass("blended.rays", in_.program(shaders::blended_rays))
        .bind<kernels::BlendedRaysBindings>({.motion = gbuffer_.motion,
                                             .rays = ray_sink(current),
                                             .radiance = to_.radiance,
                                             .transmittance = to_.transmittance,
                                             .front_motion = to_.motion,
                                             .surface = to_.surface,
                                             .specular = to_.specular})
        .constants([in = in_] { return kernels::BlendedRaysConstants{blended_region(in)}; })
        .dispatch(gpu::each_pixel())
        .host(kernels::blended_rays, in_.constants);
    for (std::uint32_t round = 0; round < most_blended; ++round) {
      in_.tracer.trace_closest(plan_, "blended.trace", in_.structure, current, hits);
      begin_rays(plan_, in_, "blended", next, Blending::stops);
      add_surfaces(round, current, hits, next);
      std::swap(current, next);
    }
  }

  /// The pixels of surfaces that the G-buffer's rasteriser has found.
  void list() {
    begin_rays(plan_, in_, "blended.lit", lit_, Blending::stops);
    plan_.host("blended.lit", {})
        .bind<kernels::BlendedLitBindings>({.radiance = to_.radiance, .lit = ray_sink(lit_)})
        .host(kernels::blended_lit, in_.constants);
  }

  /// The light on the surface that was chosen in each pixel.
  void light() {
    const auto shadows = declare_rays(plan_, "blended.shadows", pixels_, tracing::RayKind::shadow);
    const auto ambient =
        declare_rays(plan_, "blended.ambient", pixels_,
                     cache_ ? tracing::RayKind::reflection : tracing::RayKind::ambient);
    const auto reflected =
        declare_rays(plan_, "blended.specular", pixels_, tracing::RayKind::reflection);
    for (const auto* stream : {&shadows, &ambient, &reflected}) {
      begin_rays(plan_, in_, "blended.light", *stream);
    }
    // Before the weights of the choice are written over.
    std::optional<ThroughRays> through;
    if (bends_light(in_)) through = enter();
    const bool traced = in_.settings.specular.enabled;
    pass("blended.light", shaders::blended_light)
        .bind<kernels::BlendedLightBindings>({.lit = ray_source(lit_),
                                              .chosen = to_.chosen,
                                              .radiance = to_.radiance,
                                              .transmittance = to_.transmittance,
                                              .surface = to_.surface,
                                              .shadows = ray_sink(shadows),
                                              .ambient = ray_sink(ambient),
                                              .specular = ray_sink(reflected)})
        .constants([in = in_, traced, gathers = cache_.has_value()] {
          // Where other surfaces leave samples out, as in their plan.
          const bool fewer = in.settings.sampling.specular && leaves_samples_out(in);
          return kernels::BlendedLightConstants{traced ? in.settings.specular.max_roughness : -1.0f,
                                                fewer ? 1.0f / shared::plan_quiet_factor : 1.0f,
                                                gathers};
        })
        .dispatch_indirect(lit_.count, ray_groups_offset)
        .host([in = in_](const kernels::BlendedLightJob::Pass& pass) {
          const auto lights = frame_lights(in.tables.lights, in.constants);
          kernels::blended_light({pass, in.constants, lit_scene(in, lights)});
        });
    add_unoccluded_light(plan_, in_, "blended.shadows", shadows, to_.radiance);
    if (cache_) {
      gather(ambient);
    } else {
      add_unoccluded_light(plan_, in_, "blended.ambient", ambient, to_.radiance);
    }
    if (through) look_through(*through);
    if (traced) {
      trace_reflections(plan_, in_, "blended.specular", reflected, gbuffer_, to_.surface,
                        to_.transmittance, to_.specular);
    }
  }

  void compose_over(gpu::ImageRef frame, const std::function<bool()>& when = {}) {
    plan_.pass("blended.over", in_.program(shaders::blended_over))
        .bind<kernels::BlendedOverBindings>({.radiance = to_.radiance,
                                             .specular = to_.specular,
                                             .transmittance = to_.transmittance,
                                             .frame = frame})
        .dispatch(gpu::each_pixel())
        .host(kernels::blended_over)
        .when(when);
  }

 private:
  /// Rays on their way through volumes, and those that have nothing more to pass.
  struct ThroughRays {
    tracing::RayStream inside, refracted;
  };

  ThroughRays enter() {
    const ThroughRays through{
        declare_rays(plan_, "blended.inside", pixels_, tracing::RayKind::reflection),
        declare_rays(plan_, "blended.refracted", pixels_, tracing::RayKind::reflection)};
    begin_rays(plan_, in_, "blended.inside", through.inside, Blending::stops);
    begin_rays(plan_, in_, "blended.refracted", through.refracted);
    pass("blended.enter", shaders::blended_enter)
        .bind<kernels::BlendedEnterBindings>({.lit = ray_source(lit_),
                                              .chosen = to_.chosen,
                                              .radiance = to_.radiance,
                                              .transmittance = to_.transmittance,
                                              .inside = ray_sink(through.inside),
                                              .refracted = ray_sink(through.refracted)})
        .dispatch_indirect(lit_.count, ray_groups_offset)
        .host([in = in_](const kernels::BlendedEnterJob::Pass& blended) {
          const auto lights = frame_lights(in.tables.lights, in.constants);
          kernels::blended_enter({blended, in.constants, lit_scene(in, lights)});
        });
    return through;
  }

  /// The light that comes through the surfaces.
  void look_through(const ThroughRays& through) {
    tracing::RayStream current = through.inside;
    tracing::RayStream next =
        declare_rays(plan_, "blended.inside.next", pixels_, tracing::RayKind::reflection);
    const gpu::BufferRef hits = plan_.buffer("blended.inside.hits", sizeof(shared::Hit) * pixels_,
                                             storage, gpu::Memory::device);
    for (std::uint32_t round = 0; round < shared::most_boundaries; ++round) {
      in_.tracer.trace_closest(plan_, "blended.inside.trace", in_.structure, current, hits);
      begin_rays(plan_, in_, "blended.inside", next, Blending::stops);
      cross_boundaries(round, current, hits, next, through.refracted);
      std::swap(current, next);
    }
    trace_reflections(plan_, in_, "blended.refracted", through.refracted, gbuffer_, to_.surface,
                      to_.transmittance, to_.specular, cache_);
    const bool splits = kernels::disperses(in_.moving.features_without_emission());
    plan_.pass("blended.through", in_.program(shaders::blended_through))
        .bind<kernels::BlendedThroughBindings>({.rays = ray_source(through.refracted),
                                                .radiance = to_.radiance,
                                                .specular = to_.specular})
        .constants(kernels::BlendedThroughConstants{splits})
        .dispatch_indirect(through.refracted.count, ray_groups_offset)
        .host([in = in_, seen = SeenBackground(in_)](const kernels::BlendedThroughJob::Pass& pass) {
          kernels::blended_through({pass, in.constants, seen.map()});
        });
    if (splits) share_bands(through.refracted);
  }

  /// Pixels take the bands of wavelengths that their own rays do not have from their neighbours.
  void share_bands(const tracing::RayStream& rays) {
    pass("blended.bands", shaders::blended_bands)
        .bind<kernels::BlendedBandsBindings>({.rays = ray_source(rays),
                                              .chosen = to_.chosen,
                                              .through = to_.specular,
                                              .radiance = to_.radiance})
        .dispatch_indirect(rays.count, ray_groups_offset)
        .host([in = in_](const kernels::BlendedBandsJob::Pass& pass) {
          kernels::blended_bands(
              {pass, in.constants, kernels::view_scene(in.scene, in.tables, in.moving)});
        });
    plan_.pass("blended.empty", in_.program(shaders::blended_empty))
        .bind<kernels::BlendedEmptyBindings>({.rays = ray_source(rays), .emptied = to_.specular})
        .dispatch_indirect(rays.count, ray_groups_offset)
        .host(kernels::blended_empty);
  }

  void cross_boundaries(std::uint32_t round, const tracing::RayStream& inside, gpu::BufferRef hits,
                        const tracing::RayStream& next, const tracing::RayStream& refracted) {
    pass("blended.refract", shaders::blended_refract)
        .bind<kernels::BlendedRefractBindings>({.inside = ray_source(inside),
                                                .hits = hits,
                                                .chosen = to_.chosen,
                                                .next = ray_sink(next),
                                                .refracted = ray_sink(refracted)})
        .constants(kernels::BlendedRefractConstants{round, round + 1 == shared::most_boundaries})
        .dispatch_indirect(inside.count, ray_groups_offset)
        .host([in = in_](const kernels::BlendedRefractJob::Pass& pass) {
          const auto lights = frame_lights(in.tables.lights, in.constants);
          kernels::blended_refract({pass, in.constants, lit_scene(in, lights)});
        });
  }

  gpu::PassBuilder pass(const std::string& name, const gpu::ShaderBinary& shader) {
    return plan_.pass(name, in_.program(shader, in_.moving.features_without_emission()));
  }

  /// Indirect light along `rays`.
  void gather(const tracing::RayStream& rays) {
    const auto hits = plan_.buffer("blended.gathered", sizeof(shared::Hit) * rays.capacity, storage,
                                   gpu::Memory::device);
    in_.tracer.trace_closest(plan_, "blended.gather.trace", in_.structure, rays, hits);
    pass("blended.gather", shaders::blended_gather)
        .bind<kernels::BlendedGatherBindings>({.rays = ray_source(rays),
                                               .hits = hits,
                                               .keys = cache_->keys,
                                               .cells = cache_->cells,
                                               .radiance = to_.radiance})
        .constants([in = in_] { return cache_constants(in); })
        .dispatch_indirect(rays.count, ray_groups_offset)
        .host([in = in_](const kernels::BlendedGatherJob::Pass& pass) {
          kernels::blended_gather({pass, in.constants,
                                   kernels::has_layers(in.moving.features_without_emission()),
                                   kernels::view_scene(in.scene, in.tables, in.moving),
                                   host_environment(in), in.lobe_tables()});
        });
  }

  void add_surfaces(std::uint32_t round, const tracing::RayStream& rays, gpu::BufferRef hits,
                    const tracing::RayStream& next) {
    pass("blended.surfaces", shaders::blended_surfaces)
        .bind<kernels::BlendedSurfacesBindings>(
            {.met = ray_source(rays),
             .hits = hits,
             .previous_vertices = plan_.import(in_.moving.previous_vertices()),
             .rays = ray_sink(next),
             .radiance = to_.radiance,
             .transmittance = to_.transmittance,
             .front_motion = to_.motion,
             .chosen = to_.chosen,
             .lit = ray_sink(lit_)})
        .constants(kernels::BlendedSurfacesConstants{round, round + 1 == most_blended})
        .dispatch_indirect(rays.count, ray_groups_offset)
        .host([in = in_](const kernels::BlendedSurfacesJob::Pass& pass) {
          const auto lights = frame_lights(in.tables.lights, in.constants);
          kernels::blended_surfaces(
              {pass, in.constants, lit_scene(in, lights),
               (in.moving.features_without_emission() & shared::scene_deforms) != 0});
        });
  }

  gpu::FramePlan& plan_;
  const FrameInputs& in_;
  const GBuffer& gbuffer_;
  BlendedImages to_;
  std::optional<RadianceCache> cache_;
  std::uint32_t pixels_;
  tracing::RayStream lit_;  // the pixels that have a surface to light, each once
};

}  // namespace

BlendedImages declare_blended(gpu::FramePlan& plan) {
  const std::uint32_t pixels = plan.extent().width * plan.extent().height;
  const auto& buffers = blended_buffers;
  return {
      plan.image(buffers.radiance.name, four_floats),
      plan.image(buffers.transmittance.name, four_floats),
      plan.image(buffers.motion.name, four_floats),
      plan.image(buffers.specular.name, four_floats),
      plan.image(buffers.surface.name, VK_FORMAT_R8G8B8A8_UNORM),
      plan.buffer("blended.chosen", sizeof(shared::Hit) * pixels, storage, gpu::Memory::device)};
}

bool bends_light(const FrameInputs& in) {
  return in.settings.transmission.refraction &&
         (in.moving.features_without_emission() & shared::scene_transmits) != 0;
}

kernels::LitScene lit_scene(const FrameInputs& in, std::span<const shared::Light> lights) {
  const bool separate_sun = in.settings.environment.separate_sun;
  return {kernels::has_layers(in.moving.features_without_emission()),
          kernels::view_scene(in.scene, in.tables, in.moving),
          *in.moving.environment().view(separate_sun).maps.host, lights, in.lobe_tables()};
}

gpu::ImageRef blend_surfaces(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             const Composed& composed, const std::optional<RadianceCache>& cache,
                             const BlendedImages* drawn) {
  if (!has_blends(in)) return gbuffer.motion;
  const BlendedImages images = drawn ? *drawn : declare_blended(plan);
  BlendedSurfaces blended(plan, in, gbuffer, images, cache);
  drawn ? blended.list() : blended.find();
  blended.light();
  blended.compose_over(composed.hdr);
  if (composed.noisy.index != composed.hdr.index) {
    blended.compose_over(composed.noisy, composed.makes_noisy);
  }
  return images.motion;
}

}  // namespace heliograph::render
