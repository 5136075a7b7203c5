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
      .host([in](const kernels::SkyboxJob::Pass& pass) {
        // What the eye sees is the environment as it was read: with its sun.
        kernels::skybox({pass, in.constants, kernels::view_map(*in.moving.environment().source())});
      });
  return background;
}

}  // namespace heliograph::render
