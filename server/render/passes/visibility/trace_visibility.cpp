#include "render/passes/visibility/trace_visibility.hpp"

#include "render/kernels/signals.hpp"
#include "render/kernels/visibility_rays.hpp"
#include "render/passes/rays/ray_stream.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// The wavefront of one visibility signal: generate -> trace -> resolve, strip by strip.
class VisibilityTrace {
 public:
  VisibilityTrace(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                  tracing::RayKind kind, const BufferDescription& buffer)
      : plan_(plan),
        in_(in),
        name_(name),
        kind_(kind),
        visibility_(plan.image(buffer.name, VK_FORMAT_R32_SFLOAT)) {
    plan.ignore_when_skipped(visibility_);  // the frame's flags say so
  }

  gpu::ImageRef visibility() const { return visibility_; }

  /// Calls `generate(pass, rays, rows)` to complete the passes that make the rays, in frames whose
  /// flags say so. Without rays a stream stays empty and tracing it costs nothing.
  template <class Generate>
  gpu::ImageRef trace(const gpu::ProgramSource& program, bool (*traced)(std::uint32_t flags),
                      const Generate& generate) {
    for (const kernels::Rows rows : ray_strips(plan_, plan_.extent())) {
      const auto height = static_cast<std::uint32_t>(rows.bottom - rows.top);
      const auto rays = declare_rays(plan_, name_, plan_.extent().width * height, kind_);
      begin_rays(plan_, in_, name_, rays);
      gpu::PassBuilder pass = plan_.pass(name_ + ".rays", program);
      pass.dispatch(gpu::each_pixel()).when([&constants = in_.constants, traced] {
        return traced(constants.flags);
      });
      generate(pass, rays, rows);
      resolve(rays);
    }
    return visibility_;
  }

 private:
  void resolve(const tracing::RayStream& rays) {
    const auto occluded = plan_.buffer(name_ + ".occluded", sizeof(std::uint32_t) * rays.capacity,
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::device);
    in_.tracer.trace_any(plan_, name_ + ".trace", in_.structure, rays, occluded);
    plan_.pass(name_ + ".resolve", in_.program(shaders::visibility_resolve))
        .bind<kernels::VisibilityResolveBindings>(
            {.rays = ray_source(rays), .occluded = occluded, .visibility = visibility_})
        .dispatch_indirect(rays.count, ray_groups_offset)
        .host(kernels::visibility_resolve);
  }

  gpu::FramePlan& plan_;
  const FrameInputs& in_;
  std::string name_;
  tracing::RayKind kind_;
  gpu::ImageRef visibility_;
};

bool traces_shadows(std::uint32_t flags) {
  return (flags & shared::frame_shadows) != 0;
}

auto ray_constants(const FrameInputs& in, bool planned) {
  return
      [in, planned] { return kernels::VisibilityRaysConstants{planned && leaves_samples_out(in)}; };
}

}  // namespace

gpu::ImageRef trace_shadows(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                            std::optional<gpu::ImageRef> planned) {
  VisibilityTrace trace(plan, in, "shadows", tracing::RayKind::shadow, visibility_buffers.shadows);
  const auto generate = [&](gpu::PassBuilder& pass, const tracing::RayStream& rays,
                            kernels::Rows rows) {
    pass.bind<kernels::ShadowRaysBindings>({.normals = gbuffer.normals,
                                            .motion = gbuffer.motion,
                                            .base_color = gbuffer.base_color,
                                            .surface = gbuffer.surface,
                                            .layers = gbuffer.layers,
                                            .rays = ray_sink(rays),
                                            .planned = planned.value_or(gbuffer.instance),
                                            .visibility = trace.visibility()})
        .constants(ray_constants(in, planned.has_value()))
        .host([in, rows](const kernels::ShadowRaysJob::Pass& job) {
          const FrameLights lights(in.tables.lights, in.constants,
                                   in.moving.features_without_emission());
          kernels::shadows_rays({job, in.constants,
                                 kernels::has_layers(in.moving.features_without_emission()),
                                 lights.view(), in.lobe_tables(), rows});
        });
  };
  return trace.trace(in.program(shaders::shadows_rays, in.moving.features_without_emission()),
                     traces_shadows, generate);
}

gpu::ImageRef trace_ambient(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                            std::optional<gpu::ImageRef> planned) {
  VisibilityTrace trace(plan, in, "ambient", tracing::RayKind::ambient, visibility_buffers.ambient);
  const auto generate = [&](gpu::PassBuilder& pass, const tracing::RayStream& rays,
                            kernels::Rows rows) {
    pass.bind<kernels::AmbientRaysBindings>({.normals = gbuffer.normals,
                                             .motion = gbuffer.motion,
                                             .rays = ray_sink(rays),
                                             .planned = planned.value_or(gbuffer.instance),
                                             .visibility = trace.visibility()})
        .constants(ray_constants(in, planned.has_value()))
        .host([in, rows](const kernels::AmbientRaysJob::Pass& job) {
          kernels::ambient_rays({job, in.constants, rows});
        });
  };
  return trace.trace(in.program(shaders::ambient_rays), shared::traces_ambient, generate);
}

}  // namespace heliograph::render
