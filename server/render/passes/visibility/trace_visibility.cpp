#include "render/passes/visibility/trace_visibility.hpp"

#include "render/kernels/signals.hpp"
#include "render/kernels/visibility_rays.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/resources/light_table.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// The wavefront of one visibility signal: generate -> trace -> resolve.
class VisibilityTrace {
 public:
  VisibilityTrace(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                  tracing::RayKind kind, const BufferDescription& buffer)
      : plan_(plan),
        in_(in),
        name_(name),
        rays_(declare_rays(plan, name, plan.extent().width * plan.extent().height, kind)),
        visibility_(plan.image(buffer.name, VK_FORMAT_R32_SFLOAT)) {
    begin_rays(plan, in, name, rays_);
  }

  const tracing::RayStream& rays() const { return rays_; }
  gpu::ImageRef visibility() const { return visibility_; }

  /// The pass that makes the rays, in frames with `flag`. Without rays the stream stays empty and
  /// tracing it costs nothing.
  gpu::PassBuilder generate(gpu::ProgramSource program, std::uint32_t flag) {
    gpu::PassBuilder pass = plan_.pass(name_ + ".rays", std::move(program));
    pass.dispatch(gpu::each_pixel()).when([&constants = in_.constants, flag] {
      return (constants.flags & flag) != 0;
    });
    return pass;
  }

  gpu::ImageRef resolve() {
    const auto occluded = plan_.buffer(name_ + ".occluded", sizeof(std::uint32_t) * rays_.capacity,
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::device);
    in_.tracer.trace_any(plan_, name_ + ".trace", in_.structure, rays_, occluded);
    plan_.pass(name_ + ".resolve", in_.program(shaders::visibility_resolve))
        .bind<kernels::VisibilityResolveBindings>(
            {.rays = ray_source(rays_), .occluded = occluded, .visibility = visibility_})
        .dispatch_indirect(rays_.count, ray_groups_offset)
        .host(kernels::visibility_resolve);
    return visibility_;
  }

 private:
  gpu::FramePlan& plan_;
  const FrameInputs& in_;
  std::string name_;
  tracing::RayStream rays_;
  gpu::ImageRef visibility_;
};

auto ray_constants(const FrameInputs& in, bool planned) {
  return
      [in, planned] { return kernels::VisibilityRaysConstants{planned && leaves_samples_out(in)}; };
}

}  // namespace

gpu::ImageRef trace_shadows(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                            std::optional<gpu::ImageRef> planned) {
  const std::uint32_t features = in.scene.features;
  VisibilityTrace trace(plan, in, "shadows", tracing::RayKind::shadow, visibility_buffers.shadows);
  trace.generate(in.program(shaders::shadows_rays, features), shared::frame_shadows)
      .bind<kernels::ShadowRaysBindings>({.normals = gbuffer.normals,
                                          .motion = gbuffer.motion,
                                          .base_color = gbuffer.base_color,
                                          .surface = gbuffer.surface,
                                          .layers = gbuffer.layers,
                                          .rays = ray_sink(trace.rays()),
                                          .planned = planned.value_or(gbuffer.instance),
                                          .visibility = trace.visibility()})
      .constants(ray_constants(in, planned.has_value()))
      .host([in](const kernels::ShadowRaysJob::Pass& pass) {
        const auto lights = frame_lights(in.tables.lights, in.constants);
        kernels::shadows_rays(
            {pass, in.constants, kernels::has_layers(in.scene.features), lights, in.lobe_tables()});
      });
  return trace.resolve();
}

gpu::ImageRef trace_ambient(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                            std::optional<gpu::ImageRef> planned) {
  VisibilityTrace trace(plan, in, "ambient", tracing::RayKind::ambient, visibility_buffers.ambient);
  trace.generate(in.program(shaders::ambient_rays), shared::frame_ambient_occlusion)
      .bind<kernels::AmbientRaysBindings>({.normals = gbuffer.normals,
                                           .motion = gbuffer.motion,
                                           .rays = ray_sink(trace.rays()),
                                           .planned = planned.value_or(gbuffer.instance),
                                           .visibility = trace.visibility()})
      .constants(ray_constants(in, planned.has_value()))
      .host(kernels::ambient_rays, in.constants);
  return trace.resolve();
}

}  // namespace heliograph::render
