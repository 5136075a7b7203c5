#include "render/passes/section/section.hpp"

#include "render/kernels/section/section.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/section/section_tracer.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

auto cap_constants(const FrameInputs& in) {
  return [&moving = in.moving] { return section_constants(moving.section()); };
}

}  // namespace

bool has_section(const FrameInputs& in) {
  return !in.moving.section().planes.empty();
}

SectionCaps declare_caps(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name) {
  if (!has_section(in)) return std::nullopt;
  const VkExtent2D extent = plan.extent();
  return plan.buffer(name, sizeof(kernels::SectionCap) * extent.width * extent.height,
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::device);
}

void find_caps(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& rays,
               gpu::BufferRef hits, const SectionCaps& caps) {
  if (!caps) return;
  plan.pass("section.find", in.program(shaders::section_find, in.scene.features))
      .bind<kernels::SectionFindBindings>({.rays = ray_source(rays), .hits = hits, .caps = *caps})
      .constants(cap_constants(in))
      .dispatch_indirect(rays.count, ray_groups_offset)
      .host([in](const kernels::SectionFindJob::Pass& pass) {
        kernels::section_find(
            {pass, in.constants, kernels::view_scene(in.scene, in.tables, in.moving)});
      });
}

void draw_caps(gpu::FramePlan& plan, const FrameInputs& in, const SectionCaps& caps,
               const GBuffer& gbuffer) {
  if (!caps) return;
  plan.pass("section.draw", in.program(shaders::section_draw))
      .bind<kernels::SectionDrawBindings>({.caps = *caps,
                                           .normals = gbuffer.normals,
                                           .base_color = gbuffer.base_color,
                                           .surface = gbuffer.surface,
                                           .motion = gbuffer.motion,
                                           .emissive = gbuffer.emissive,
                                           .depth_slope = gbuffer.depth_slope,
                                           .instance = gbuffer.instance})
      .constants(cap_constants(in))
      .dispatch(gpu::each_pixel())
      .host([&frame = in.constants](const kernels::SectionDrawJob::Pass& pass) {
        kernels::section_draw({pass, frame});
      });
}

void color_caps(gpu::FramePlan& plan, const FrameInputs& in, const SectionCaps& caps,
                gpu::ImageRef radiance) {
  if (!caps) return;
  plan.pass("section.color", in.program(shaders::section_color))
      .bind<kernels::SectionColorBindings>({.caps = *caps, .radiance = radiance})
      .constants(cap_constants(in))
      .dispatch(gpu::each_pixel())
      .host(kernels::section_color);
}

}  // namespace heliograph::render
