#include "render/passes/section/section.hpp"

#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/section/section_tracer.hpp"
#include "render/resources/moving_scene.hpp"
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
  return plan.buffer(name, sizeof(glm::uvec2) * extent.width * extent.height,
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::device);
}

void find_caps(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& rays,
               gpu::BufferRef hits, const SectionCaps& caps) {
  if (!caps) return;
  plan.pass("section.find", in.program(shaders::section_find, in.scene.features))
      .read(rays.count)
      .read(rays.rays)
      .read(hits)
      .write(*caps)
      .constants(cap_constants(in))
      .dispatch_indirect(rays.count, ray_groups_offset);
}

void draw_caps(gpu::FramePlan& plan, const FrameInputs& in, const SectionCaps& caps,
               const GBuffer& gbuffer) {
  if (!caps) return;
  plan.pass("section.draw", in.program(shaders::section_draw))
      .read(*caps)
      .read_write(gbuffer.normals)
      .read_write(gbuffer.base_color)
      .read_write(gbuffer.surface)
      .read_write(gbuffer.motion)
      .read_write(gbuffer.emissive)
      .read_write(gbuffer.depth_slope)
      .read_write(gbuffer.instance)
      .constants(cap_constants(in))
      .dispatch(gpu::each_pixel());
}

void color_caps(gpu::FramePlan& plan, const FrameInputs& in, const SectionCaps& caps,
                gpu::ImageRef radiance) {
  if (!caps) return;
  plan.pass("section.color", in.program(shaders::section_color))
      .read(*caps)
      .read_write(radiance)
      .constants(cap_constants(in))
      .dispatch(gpu::each_pixel());
}

}  // namespace heliograph::render
