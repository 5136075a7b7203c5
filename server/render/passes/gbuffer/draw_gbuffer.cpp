#include "render/passes/gbuffer/draw_gbuffer.hpp"

#include "render/kernels/gbuffer/gbuffer_draw.hpp"
#include "render/passes/gbuffer/frustum.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/resources/moving_scene.hpp"

namespace heliograph::render {
namespace {

/// A ray takes as long as so many triangles: 128 ns in an atrium against 10 to 20 ns for a triangle
/// that is projected and, one of several, drawn.
constexpr std::uint64_t triangles_per_ray = 8;

/// What may be in view.
std::vector<const Draw*> visible_draws(const FrameInputs& in) {
  const Frustum frustum(in.constants.view_projection);
  std::vector<const Draw*> draws;
  for (const Draw& draw : in.moving.draws()) {
    if (frustum.may_contain(draw.bounds)) draws.push_back(&draw);
  }
  return draws;
}

}  // namespace

bool draws_gbuffer_on_host(const gpu::FramePlan& plan, const FrameInputs& in) {
  using enum protocol::PrimaryVisibility;
  if (!plan.uses_host_kernels()) return false;
  if (in.settings.gbuffer.source != automatic) return in.settings.gbuffer.source == raster;
  const std::uint64_t pixels = std::uint64_t{plan.extent().width} * plan.extent().height;
  std::uint64_t triangles = 0;
  for (const Draw& draw : in.moving.draws()) triangles += draw.index_count / 3;
  return triangles < triangles_per_ray * pixels;
}

GBuffer draw_gbuffer(gpu::FramePlan& plan, const FrameInputs& in) {
  GBuffer gbuffer = declare_gbuffer(plan, in.scene.features);
  const bool layered = kernels::has_layers(in.scene.features);
  const CameraStreams streams = declare_camera_streams(plan);
  const auto triangles = std::make_shared<kernels::ScreenTriangles>();
  plan.host("gbuffer.triangles", [in, triangles] {
    kernels::project_triangles(in.constants, kernels::view_scene(in.scene, in.tables, in.moving),
                               visible_draws(in), *triangles);
  });
  // Camera rays decide for themselves, by the filtered texel: as drawn triangles do.
  begin_rays(plan, in, "gbuffer", streams.current, Blending::stops);
  plan.host("gbuffer.draw", {})
      .bind<kernels::GBufferDrawBindings>(
          {.passed = ray_sink(streams.current),
           .normals = gbuffer.normals,
           .base_color = gbuffer.base_color,
           .surface = gbuffer.surface,
           .motion = gbuffer.motion,
           .emissive = gbuffer.emissive,
           .depth_slope = gbuffer.depth_slope,
           .instance = gbuffer.instance,
           .layers = layered ? std::optional(gbuffer.layers) : std::nullopt})
      .host([in, triangles](const kernels::GBufferDrawJob::Pass& pass) {
        kernels::gbuffer_draw({pass, in.constants,
                               kernels::view_scene(in.scene, in.tables, in.moving),
                               (in.scene.features & shared::scene_deforms) != 0, *triangles});
      });
  trace_rounds(plan, in, streams, 2, gbuffer);
  return gbuffer;
}

}  // namespace heliograph::render
