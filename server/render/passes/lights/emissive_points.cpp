#include "render/passes/lights/emissive_points.hpp"

#include "render/kernels/lights/emissive_points.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/reflections/trace_specular.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

using formats::storage;

namespace {

/// Whether the scene has emissive triangles, or may have them without a new plan.
bool has_emissive(const FrameInputs& in) {
  return (in.moving.features() & shared::scene_emissive) != 0;
}

}  // namespace

bool samples_emissive(const FrameInputs& in) {
  return has_emissive(in) && (in.constants.flags & shared::frame_emissive) != 0;
}

gpu::BufferRef draw_emissive_points(gpu::FramePlan& plan, const FrameInputs& in) {
  const std::size_t count = has_emissive(in) ? shared::emissive_points : 1;
  const auto points = plan.buffer("emissive.points", sizeof(shared::EmissivePoint) * count, storage,
                                  gpu::Memory::device);
  if (!has_emissive(in)) return points;
  plan.pass("emissive.points", in.program(shaders::emissive_points, in.moving.features()))
      .bind<kernels::EmissivePointsBindings>({.points = points})
      .dispatch({shared::emissive_points, 1})
      .when([in] { return samples_emissive(in); })
      .host([in](const kernels::EmissivePointsJob::Pass& pass) {
        kernels::emissive_points(
            {pass, in.constants, kernels::view_scene(in.scene, in.tables, in.moving)});
      });
  return points;
}

void add_emissive_light(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                        gpu::BufferRef points, gpu::ImageRef radiance, kernels::Rows rows) {
  if (!has_emissive(in)) return;
  const auto height = static_cast<std::uint32_t>(rows.bottom - rows.top);
  const auto rays = declare_rays(plan, "indirect.lights", plan.extent().width * height,
                                 tracing::RayKind::hit_shadow);
  begin_rays(plan, in, "indirect.lights", rays);
  plan.pass("indirect.lights", in.program(shaders::indirect_lights, in.moving.features()))
      .bind<kernels::IndirectLightsBindings>({.normals = gbuffer.normals,
                                              .motion = gbuffer.motion,
                                              .radiance = radiance,
                                              .points = points,
                                              .rays = ray_sink(rays),
                                              .base_color = gbuffer.base_color,
                                              .surface = gbuffer.surface,
                                              .layers = gbuffer.layers})
      .dispatch(gpu::each_pixel())
      .when([in] { return samples_emissive(in); })
      .host([in, rows](const kernels::IndirectLightsJob::Pass& pass) {
        kernels::indirect_lights({pass, in.constants,
                                  kernels::scatters_through(in.moving.features_without_emission()),
                                  in.lobe_tables(), rows});
      });
  add_unoccluded_light(plan, in, "indirect.lights", rays, radiance);
}

}  // namespace heliograph::render
