#include "render/passes/shading/draw_shading.hpp"

#include "render/kernels/shading/shading_draw.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using protocol::ShadingMode;

/// shared::shading_* stand in the order of the setting's choices.
std::uint32_t mode_of(const protocol::Settings& settings) {
  static_assert(static_cast<std::uint32_t>(ShadingMode::wireframe) == shared::shading_wireframe);
  static_assert(static_cast<std::uint32_t>(ShadingMode::normals) == shared::shading_normals);
  return static_cast<std::uint32_t>(settings.view.shading);
}

}  // namespace

bool changes_shading(const FrameInputs& in) {
  return in.settings.view.shading != ShadingMode::lit;
}

bool is_plain(const protocol::Settings& settings) {
  const ShadingMode mode = settings.view.shading;
  return mode != ShadingMode::lit && mode != ShadingMode::wireframe;
}

void choose_shading(protocol::Settings& settings) {
  const ShadingMode mode = settings.view.shading;
  if (mode == ShadingMode::lit || mode == ShadingMode::clay) return;
  settings.reference.use = protocol::ReferenceUse::off;
  if (mode == ShadingMode::wireframe) return;
  settings.shadows.enabled = false;
  settings.ambient.occlusion = false;
  settings.specular.enabled = false;
  settings.indirect.enabled = false;
  settings.exposure.mode = protocol::ExposureMode::manual;
  settings.exposure.compensation = 0.0f;
  settings.tone_map.curve = protocol::ToneMapCurve::linear;
}

void draw_shading(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& rays,
                  gpu::BufferRef hits, const GBuffer& gbuffer) {
  if (!changes_shading(in)) return;
  plan.pass("shading.draw", in.program(shaders::shading_draw, in.scene.features))
      .bind<kernels::ShadingDrawBindings>({.rays = ray_source(rays),
                                           .hits = hits,
                                           .normals = gbuffer.normals,
                                           .base_color = gbuffer.base_color,
                                           .surface = gbuffer.surface,
                                           .emissive = gbuffer.emissive})
      .constants([&settings = in.settings] { return shared::ShadingConstants{mode_of(settings)}; })
      .dispatch_indirect(rays.count, ray_groups_offset)
      .host([in](const kernels::ShadingDrawJob::Pass& pass) {
        kernels::shading_draw(
            {pass, in.constants, kernels::view_scene(in.scene, in.tables, in.moving)});
      });
}

}  // namespace heliograph::render
