#include "render/passes/compose/skybox.hpp"

#include "render/kernels/skybox.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/resources/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

gpu::ImageRef draw_skybox(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  const auto background = plan.image(skybox_buffers.radiance.name, VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("skybox", in.program(shaders::skybox))
      .bind<kernels::SkyboxBindings>({.motion = gbuffer.motion, .background = background})
      .dispatch(gpu::each_pixel())
      .host([in, chosen = in.moving.environment().background(in.settings.background)](
                const kernels::SkyboxJob::Pass& pass) {
        // The environment is seen as it was read: with its sun.
        const scene::Environment& seen = chosen ? chosen->map : *in.moving.environment().source();
        kernels::skybox({pass, in.constants, kernels::view_map(seen)});
      });
  return background;
}

}  // namespace heliograph::render
