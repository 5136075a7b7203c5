#include "render/passes/reflections/trace_specular.hpp"

#include <optional>

#include "render/kernels/specular.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/rays/sort_rays.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::four_floats;
using formats::storage;

/// What rays write: of the plan's size, or of half of it with the direction of every ray.
struct Target {
  gpu::ImageRef radiance;
  std::optional<gpu::ImageRef> directions;
  gpu::FrameSize size;
  std::int32_t scale;
};

Target make_target(gpu::FramePlan& plan, bool half) {
  const auto& buffers = specular_buffers;
  if (!half) return {plan.image(buffers.radiance.name, four_floats), {}, gpu::each_pixel(), 1};
  const auto half_size = gpu::FrameSize::squares(2);
  return {plan.image(buffers.half_radiance.name, four_floats, 0, half_size),
          plan.image(buffers.half_directions.name, four_floats, 0, half_size), half_size, 2};
}

tracing::RayStream generate_rays(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Target& target, kernels::Rows rows,
                                 std::optional<gpu::ImageRef> planned) {
  const std::uint32_t features = in.moving.features_without_emission();
  const auto height = static_cast<std::uint32_t>(rows.bottom - rows.top);
  const auto rays = declare_rays(plan, "specular", target.size.of(plan.extent()).width * height,
                                 tracing::RayKind::reflection);
  const auto& shader = target.directions ? shaders::specular_rays_half : shaders::specular_rays;
  begin_rays(plan, in, "specular", rays);
  plan.pass("specular.rays", in.program(shader, features))
      .bind<kernels::SpecularRaysBindings>({.normals = gbuffer.normals,
                                            .base_color = gbuffer.base_color,
                                            .surface = gbuffer.surface,
                                            .layers = gbuffer.layers,
                                            .motion = gbuffer.motion,
                                            .rays = ray_sink(rays),
                                            .planned = planned.value_or(gbuffer.instance),
                                            .radiance = target.radiance,
                                            .directions = target.directions})
      .constants([in, has_plan = planned.has_value()] {
        return kernels::SpecularRaysConstants{in.settings.specular.max_roughness,
                                              has_plan && leaves_samples_out(in)};
      })
      .dispatch(target.size)
      .host([in, rows](const kernels::SpecularRaysJob::Pass& pass) {
        const bool separate_sun = in.settings.environment.separate_sun;
        kernels::specular_rays(
            {pass, in.constants, kernels::has_layers(in.moving.features_without_emission()),
             in.lobe_tables(), *in.moving.environment().view(separate_sun).maps.host, rows});
      });
  return in.settings.specular.sort_rays ? sort_rays(plan, in, "specular", rays) : rays;
}

/// Shadows of the frame before, or an image that nothing is read from.
struct ShownBefore {
  gpu::ImageRef visibility;
  bool known;
};

ShownBefore shown_before(gpu::FramePlan& plan, const std::string& name,
                         std::optional<gpu::ImageRef> visibility) {
  if (visibility) return {*visibility, true};
  return {plan.image(name + ".shown_before", formats::four_fractions, 0, {1, 1}), false};
}

/// What the rays hit, the shadow rays from there, and where others are known from.
struct Hits {
  std::string name;
  tracing::RayStream rays;
  gpu::BufferRef hits;
  tracing::RayStream shadows;
  ShownBefore before;
  std::optional<RadianceCache> cache;
};

/// Shades the hits; makes the shadow rays toward their lights.
void shade(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer, const Hits& hits,
           const Target& target) {
  const std::uint32_t features = in.moving.features_without_emission();
  begin_rays(plan, in, hits.name + ".shadows", hits.shadows);
  const auto& shader = hits.cache ? shaders::specular_shade_indirect : shaders::specular_shade;
  std::optional<gpu::BufferRef> keys, cells;
  if (hits.cache) keys = hits.cache->keys, cells = hits.cache->cells;
  plan.pass(hits.name + ".shade", in.program(shader, features))
      .bind<kernels::SpecularShadeBindings>({.surface = gbuffer.surface,
                                             .motion = gbuffer.motion,
                                             .rays = ray_source(hits.rays),
                                             .hits = hits.hits,
                                             .shadows = ray_sink(hits.shadows),
                                             .radiance = target.radiance,
                                             .previous_motion = gbuffer.previous_motion,
                                             .previous_instance = gbuffer.previous_instance,
                                             .visibility = hits.before.visibility,
                                             .cache_keys = keys,
                                             .cache_cells = cells})
      .constants([in, scale = target.scale, known = hits.before.known] {
        const auto& s = in.settings.specular;
        const bool traced = s.hit_shading == protocol::HitShading::traced;
        return kernels::SpecularShadeConstants{
            traced, scale,
            known && s.reuse_shadows && leaves_visibility_out(in) &&
                (in.constants.flags & shared::frame_shadows) != 0,
            traced && in.settings.indirect.rough_reflections, cache_constants(in)};
      })
      .dispatch_indirect(hits.rays.count, ray_groups_offset)
      .host([in](const kernels::SpecularShadeJob::Pass& pass) {
        const FrameLights lights(in.tables.lights, in.constants,
                                 in.moving.features_without_emission());
        const bool separate_sun = in.settings.environment.separate_sun;
        kernels::specular_shade({pass, in.constants,
                                 kernels::has_layers(in.moving.features_without_emission()),
                                 kernels::view_scene(in.scene, in.tables, in.moving),
                                 *in.moving.environment().view(separate_sun).maps.host,
                                 lights.view(), in.lobe_tables()});
      });
}

/// Adds the light of shadow rays that are not occluded.
void resolve_lights(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                    const tracing::RayStream& shadows, const Target& target) {
  const auto occluded = plan.buffer(name + ".occluded", sizeof(std::uint32_t) * shadows.capacity,
                                    storage, gpu::Memory::device);
  in.tracer.trace_any(plan, name + ".shadows.trace", in.structure, shadows, occluded);
  plan.pass(name + ".resolve", in.program(shaders::specular_resolve))
      .bind<kernels::SpecularResolveBindings>(
          {.shadows = ray_source(shadows), .occluded = occluded, .radiance = target.radiance})
      .constants(kernels::SpecularResolveConstants{target.scale})
      .dispatch_indirect(shadows.count, ray_groups_offset)
      .host(kernels::specular_resolve);
}

void trace_and_shade(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                     const tracing::RayStream& rays, const GBuffer& gbuffer, const Target& target,
                     const ShownBefore& before, const std::optional<RadianceCache>& cache) {
  const auto hits = plan.buffer(name + ".hits", sizeof(shared::Hit) * rays.capacity, storage,
                                gpu::Memory::device);
  in.tracer.trace_closest(plan, name + ".trace", in.structure, rays, hits);
  const auto shadows =
      declare_rays(plan, name + ".shadows", rays.capacity, tracing::RayKind::hit_shadow);
  shade(plan, in, gbuffer, {name, rays, hits, shadows, before, cache}, target);
  resolve_lights(plan, in, name, shadows, target);
}

gpu::ImageRef upsample(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                       const Target& half) {
  const auto radiance = plan.image(specular_buffers.radiance.name, four_floats);
  plan.pass("specular.upsample",
            in.program(shaders::specular_upsample, in.moving.features_without_emission()))
      .read(gbuffer.normals)
      .read(gbuffer.base_color)
      .read(gbuffer.surface)
      .read(gbuffer.layers)
      .read(gbuffer.motion)
      .read(half.radiance)
      .read(*half.directions)
      .write(radiance)
      .constants([&s = in.settings.specular] { return s.max_roughness; })
      .dispatch(gpu::each_pixel());
  return radiance;
}

}  // namespace

gpu::ImageRef trace_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             std::optional<gpu::ImageRef> planned,
                             std::optional<gpu::ImageRef> visibility,
                             const std::optional<RadianceCache>& cache) {
  const Target target = make_target(plan, in.settings.specular.half_resolution);
  if (target.directions) planned.reset();
  const ShownBefore before = shown_before(plan, "specular", visibility);
  for (const kernels::Rows rows : ray_strips(plan, target.size.of(plan.extent()))) {
    const auto rays = generate_rays(plan, in, gbuffer, target, rows, planned);
    trace_and_shade(plan, in, "specular", rays, gbuffer, target, before, cache);
  }
  return target.directions ? upsample(plan, in, gbuffer, target) : target.radiance;
}

void trace_reflections(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                       const tracing::RayStream& rays, const GBuffer& behind, gpu::ImageRef surface,
                       gpu::ImageRef distance, gpu::ImageRef radiance,
                       const std::optional<RadianceCache>& cache) {
  GBuffer reflecting = behind;
  reflecting.surface = surface;
  reflecting.motion = distance;
  trace_and_shade(plan, in, name, rays, reflecting, {radiance, {}, gpu::each_pixel(), 1},
                  shown_before(plan, name, {}), cache);
}

void add_unoccluded_light(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                          const tracing::RayStream& rays, gpu::ImageRef radiance) {
  resolve_lights(plan, in, name, rays, {radiance, {}, gpu::each_pixel(), 1});
}

}  // namespace heliograph::render
