#include "render/trace_visibility.hpp"

#include "render/ray_stream.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Generate -> trace -> bring back: the wavefront of one visibility signal.
gpu::ImageRef trace_visibility(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                               const gpu::ComputeProgram& generator,
                               const std::vector<gpu::ImageRef>& images, std::uint32_t flag) {
  const VkExtent2D extent = plan.extent();
  const std::uint32_t pixels = extent.width * extent.height;
  constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const tracing::RayStream rays = declare_rays(plan, name, pixels);
  const auto occluded =
      plan.buffer(name + ".occluded", sizeof(std::uint32_t) * pixels, usage, gpu::Memory::device);
  const auto visibility = plan.image(name + ".visibility", VK_FORMAT_R32_SFLOAT);
  // Without new rays the stream stays empty and tracing it costs nothing.
  const auto wanted = [&constants = in.constants, flag] {
    return (constants.counts.y & flag) != 0;
  };

  begin_rays(plan, in, name, rays);
  auto pass = plan.pass(name + ".rays", generator);
  for (const gpu::ImageRef image : images) pass.read(image);
  pass.read_write(rays.count)
      .write(rays.rays)
      .write(visibility)
      .dispatch(extent)
      .when(wanted);
  in.tracer.trace_any(plan, name + ".trace", in.structure, rays, occluded);
  plan.pass(name + ".resolve", in.programs.compute(shaders::resolve_visibility))
      .read(rays.count)
      .read(rays.rays)
      .read(occluded)
      .write(visibility)
      .dispatch_indirect(rays.count, ray_groups_offset);
  return visibility;
}

}  // namespace

gpu::ImageRef trace_shadows(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  return trace_visibility(plan, in, "shadows", in.programs.compute(shaders::shadow_rays, in.scene.features),
                          {gbuffer.normals, gbuffer.motion, gbuffer.base_color, gbuffer.surface},
                          shared::frame_shadows);
}

gpu::ImageRef trace_ambient(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  return trace_visibility(plan, in, "ambient", in.programs.compute(shaders::ambient_rays),
                          {gbuffer.normals, gbuffer.motion}, shared::frame_ambient_occlusion);
}

}  // namespace heliograph::render
