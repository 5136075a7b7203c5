#include "render/passes/gbuffer/draw_gbuffer.hpp"

#include <algorithm>

#include "render/kernels/gbuffer/gbuffer_draw.hpp"
#include "render/passes/gbuffer/frustum.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/section/section.hpp"
#include "render/passes/shading/draw_shading.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving/moving_scene.hpp"

namespace heliograph::render {
namespace {

/// A ray takes as long as so many triangles: 128 ns in an atrium against 10 to 20 ns for a triangle
/// that is projected and, one of several, drawn.
constexpr std::uint64_t triangles_per_ray = 8;

/// What may be in view; what may let rays pass comes last.
std::vector<const Draw*> visible_draws(const FrameInputs& in) {
  const Frustum frustum(in.constants.view_projection);
  std::vector<const Draw*> draws;
  for (const Draw& draw : in.moving.draws()) {
    if (frustum.may_contain(draw.bounds)) draws.push_back(&draw);
  }
  std::stable_partition(draws.begin(), draws.end(), [](const Draw* draw) { return !draw->masked; });
  return draws;
}

/// Layers of a pixel that are drawn at least, where all in front are open: one more costs the
/// pixels that need it alone, and of leaves behind leaves the last would look solid.
constexpr std::uint32_t least_layers = 16;

}  // namespace

bool draws_gbuffer_on_host(const gpu::FramePlan& plan, const FrameInputs& in) {
  using enum protocol::PrimaryVisibility;
  if (!plan.uses_host_kernels() || has_section(in) || changes_shading(in)) return false;
  if (in.settings.gbuffer.source != automatic) return in.settings.gbuffer.source == raster;
  const std::uint64_t pixels = std::uint64_t{plan.extent().width} * plan.extent().height;
  std::uint64_t triangles = 0;
  for (const Draw& draw : in.moving.draws()) triangles += draw.index_count / 3;
  return triangles < triangles_per_ray * pixels;
}

GBuffer draw_gbuffer(gpu::FramePlan& plan, const FrameInputs& in, const BlendedImages* blended) {
  GBuffer gbuffer = declare_gbuffer(plan, in.moving.features_without_emission());
  const auto triangles = std::make_shared<kernels::ScreenTriangles>();
  plan.host("gbuffer.triangles", [in, triangles] {
    kernels::project_triangles(in.constants, kernels::view_scene(in.scene, in.tables, in.moving),
                               visible_draws(in), *triangles);
  });
  const auto given = [](bool present, auto resource) {
    return present ? std::optional(resource) : std::nullopt;
  };
  const bool blends = blended != nullptr;
  const BlendedImages to = blends ? *blended : BlendedImages();
  plan.host("gbuffer.draw", {})
      .bind<kernels::GBufferDrawBindings>(
          {.normals = gbuffer.normals,
           .base_color = gbuffer.base_color,
           .surface = gbuffer.surface,
           .motion = gbuffer.motion,
           .emissive = gbuffer.emissive,
           .depth_slope = gbuffer.depth_slope,
           .instance = gbuffer.instance,
           .layers =
               given(kernels::has_layers(in.moving.features_without_emission()), gbuffer.layers),
           .blended_radiance = given(blends, to.radiance),
           .blended_transmittance = given(blends, to.transmittance),
           .blended_motion = given(blends, to.motion),
           .blended_surface = given(blends, to.surface),
           .blended_specular = given(blends, to.specular),
           .blended_chosen = given(blends, to.chosen)})
      .host([in, triangles, blends, &plan](const kernels::GBufferDrawJob::Pass& pass) {
        const auto lights = frame_lights(in.tables.lights, in.constants);
        const kernels::LitScene lit = lit_scene(in, lights);
        kernels::gbuffer_draw({pass, in.constants, lit.scene,
                               (in.moving.features_without_emission() & shared::scene_deforms) != 0,
                               *triangles, std::max(camera_rounds(in), least_layers), most_blended,
                               blends ? &lit : nullptr, plan});
      });
  return gbuffer;
}

}  // namespace heliograph::render
