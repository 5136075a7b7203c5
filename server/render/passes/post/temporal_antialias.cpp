#include "render/passes/post/temporal_antialias.hpp"

#include "render/kernels/post/temporal_antialias.hpp"
#include "render/passes/frame_inputs.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

gpu::ImageRef temporal_antialias(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Exposure& exposure,
                                 gpu::ImageRef radiance) {
  if (!in.settings.antialiasing.temporal && !in.shown) return radiance;
  const VkExtent2D shown = in.shown.value_or(plan.extent());
  const auto history = plan.history(temporal_antialias_buffers.resolved.name,
                                    VK_FORMAT_R32G32B32A32_SFLOAT, 0, shown);
  plan.pass("temporal_antialias", in.program(shaders::temporal_antialias))
      .bind<kernels::AntialiasBindings>({.radiance = radiance,
                                         .motion = gbuffer.motion,
                                         .history = history.previous,
                                         .exposure = exposure.state,
                                         .resolved = history.current})
      .constants([&s = in.settings.antialiasing, shown] {
        return kernels::AntialiasConstants{{shown.width, shown.height},
                                           s.temporal ? s.blend : 1.0f,
                                           s.clip,
                                           s.anti_flicker ? 1.0f : 0.0f};
      })
      .dispatch(shown)
      .host(kernels::temporal_antialias, in.constants);
  return history.current;
}

}  // namespace heliograph::render
