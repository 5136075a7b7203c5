#include "render/passes/indirect/trace_indirect.hpp"

#include "render/kernels/indirect/radiance_cache.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/indirect/radiance_cache.hpp"
#include "render/passes/lights/emissive_points.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

using formats::storage;

namespace {

void gather(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
            const RadianceCache& cache, std::optional<gpu::ImageRef> planned,
            gpu::ImageRef radiance, kernels::Rows rows) {
  const auto height = static_cast<std::uint32_t>(rows.bottom - rows.top);
  const auto rays =
      declare_rays(plan, "indirect", plan.extent().width * height, tracing::RayKind::reflection);
  begin_rays(plan, in, "indirect", rays);
  plan.pass("indirect.rays", in.program(shaders::indirect_rays, in.moving.features()))
      .bind<kernels::IndirectRaysBindings>({.normals = gbuffer.normals,
                                            .motion = gbuffer.motion,
                                            .rays = ray_sink(rays),
                                            .planned = planned.value_or(gbuffer.instance),
                                            .radiance = radiance,
                                            .guide = cache.guide,
                                            .base_color = gbuffer.base_color,
                                            .surface = gbuffer.surface,
                                            .layers = gbuffer.layers})
      .constants([in, has_plan = planned.has_value()] {
        const shared::RadianceCacheConstants cells = cache_constants(in);
        return kernels::IndirectRaysConstants{has_plan && leaves_samples_out(in), cells.guided,
                                              cells.cell_angle, cells.least_size};
      })
      .dispatch(gpu::each_pixel())
      .host([in, rows](const kernels::IndirectRaysJob::Pass& pass) {
        kernels::indirect_rays({pass, in.constants,
                                kernels::scatters_through(in.moving.features_without_emission()),
                                in.lobe_tables(), rows});
      });
  const auto hits = plan.buffer("indirect.hits", sizeof(shared::Hit) * rays.capacity, storage,
                                gpu::Memory::device);
  in.tracer.trace_closest(plan, "indirect.trace", in.structure, rays, hits);
  plan.pass("indirect.shade", in.program(shaders::indirect_shade, in.moving.features()))
      .bind<kernels::IndirectShadeBindings>({.rays = ray_source(rays),
                                             .hits = hits,
                                             .keys = cache.keys,
                                             .cells = cache.cells,
                                             .radiance = radiance})
      .constants([in] { return cache_constants(in); })
      .dispatch_indirect(rays.count, ray_groups_offset)
      .host([in](const kernels::IndirectShadeJob::Pass& pass) {
        kernels::indirect_shade({pass, in.constants,
                                 kernels::has_layers(in.moving.features_without_emission()),
                                 kernels::view_scene(in.scene, in.tables, in.moving),
                                 host_environment(in), in.lobe_tables()});
      });
}

}  // namespace

gpu::ImageRef trace_indirect(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                             const RadianceCache& cache, std::optional<gpu::ImageRef> planned) {
  const auto radiance = plan.image(indirect_buffers.radiance.name, formats::four_floats);
  for (const kernels::Rows rows : ray_strips(plan, plan.extent())) {
    gather(plan, in, gbuffer, cache, planned, radiance, rows);
    add_emissive_light(plan, in, gbuffer, cache.points, radiance, rows);
  }
  return radiance;
}

}  // namespace heliograph::render
