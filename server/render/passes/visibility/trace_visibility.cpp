#include "render/passes/visibility/trace_visibility.hpp"

#include "render/kernels/signals.hpp"
#include "render/kernels/visibility_rays.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/resources/light_table.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// How the rays of one visibility signal are made: the shader with its images, and the kernel for
/// devices that are processors, where there is one.
struct Generation {
  std::string name;
  const gpu::ComputeProgram& shader;
  std::vector<gpu::ImageRef> images;
  std::uint32_t flag;
  std::function<void(const kernels::VisibilityRaysJob&)> kernel;
};

gpu::PassBuilder generation_pass(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Generation& generation,
                                 const tracing::RayStream& rays, gpu::ImageRef visibility) {
  const std::string name = generation.name + ".rays";
  if (!on_host(plan, in) || !generation.kernel) {
    return plan.pass(name, generation.shader).dispatch(plan.extent());
  }
  return plan.host(
      name, [&plan, &frame = in.constants, gbuffer, kernel = generation.kernel, rays, visibility] {
        const auto view = [&plan](gpu::ImageRef image) { return plan.get(image).host(); };
        kernel({.frame = frame,
                .width = static_cast<int>(plan.extent().width),
                .height = static_cast<int>(plan.extent().height),
                .normals = view(gbuffer.normals),
                .motion = view(gbuffer.motion),
                .count = reinterpret_cast<shared::RayCount*>(plan.get(rays.count).mapped()),
                .rays = reinterpret_cast<shared::Ray*>(plan.get(rays.rays).mapped()),
                .visibility = view(visibility)});
      });
}

/// Brings the answers back to their pixels.
void resolve(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
             const tracing::RayStream& rays, gpu::BufferRef occluded, gpu::ImageRef visibility) {
  const auto declare = [&] {
    if (!on_host(plan, in)) {
      return plan.pass(name, in.programs.compute(shaders::visibility_resolve))
          .dispatch_indirect(rays.count, ray_groups_offset);
    }
    return plan.host(name, [&plan, rays, occluded, visibility] {
      const auto words = [&plan](gpu::BufferRef buffer) { return plan.get(buffer).mapped(); };
      kernels::resolve_visibility(
          {.count = *reinterpret_cast<const shared::RayCount*>(words(rays.count)),
           .rays = reinterpret_cast<const shared::Ray*>(words(rays.rays)),
           .occluded = reinterpret_cast<const std::uint32_t*>(words(occluded)),
           .visibility = plan.get(visibility).host()});
    });
  };
  declare().read(rays.count).read(rays.rays).read(occluded).write(visibility);
}

/// Generate -> trace -> bring back: the wavefront of one visibility signal.
gpu::ImageRef trace_visibility(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Generation& generation) {
  const std::string& name = generation.name;
  const VkExtent2D extent = plan.extent();
  const std::uint32_t pixels = extent.width * extent.height;
  constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  const tracing::RayStream rays = declare_rays(plan, name, pixels);
  const auto occluded =
      plan.buffer(name + ".occluded", sizeof(std::uint32_t) * pixels, usage, gpu::Memory::device);
  const auto visibility = plan.image(name + ".visibility", VK_FORMAT_R32_SFLOAT);
  // Without new rays the stream stays empty and tracing it costs nothing.
  const auto wanted = [&constants = in.constants, flag = generation.flag] {
    return (constants.flags & flag) != 0;
  };

  begin_rays(plan, in, name, rays);
  auto pass = generation_pass(plan, in, gbuffer, generation, rays, visibility);
  for (const gpu::ImageRef image : generation.images) pass.read(image);
  pass.read_write(rays.count).write(rays.rays).write(visibility).when(wanted);
  in.tracer.trace_any(plan, name + ".trace", in.structure, rays, occluded);
  resolve(plan, in, name + ".resolve", rays, occluded, visibility);
  return visibility;
}

}  // namespace

gpu::ImageRef trace_shadows(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  Generation generation{.name = "shadows",
                        .shader = in.programs.compute(shaders::shadows_rays, in.scene.features),
                        .images = {gbuffer.normals, gbuffer.motion, gbuffer.base_color,
                                   gbuffer.surface, gbuffer.layers},
                        .flag = shared::frame_shadows,
                        .kernel = {}};
  if ((in.scene.features & (shared::scene_area_lights | shared::scene_layers)) == 0) {
    generation.kernel = [&plan, in, gbuffer](const kernels::VisibilityRaysJob& common) {
      const auto lights = frame_lights(in.tables.lights, in.constants);
      kernels::shadow_rays({common, lights, plan.get(gbuffer.base_color).host(),
                            plan.get(gbuffer.surface).host(), in.split_sum_table.host(),
                            static_cast<int>(in.split_sum_table.desc().extent.width)});
    };
  }
  return trace_visibility(plan, in, gbuffer, generation);
}

gpu::ImageRef trace_ambient(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  return trace_visibility(plan, in, gbuffer,
                          {.name = "ambient",
                           .shader = in.programs.compute(shaders::ambient_rays),
                           .images = {gbuffer.normals, gbuffer.motion},
                           .flag = shared::frame_ambient_occlusion,
                           .kernel = kernels::ambient_rays});
}

}  // namespace heliograph::render
