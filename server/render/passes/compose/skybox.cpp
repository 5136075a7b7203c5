#include "render/passes/compose/skybox.hpp"

#include "render/passes/frame_inputs.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

gpu::ImageRef draw_skybox(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer) {
  const auto background = plan.image(skybox_buffers.radiance.name, VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("skybox", in.program(shaders::skybox))
      .read(gbuffer.motion)
      .write(background)
      .dispatch(plan.extent());
  return background;
}

}  // namespace heliograph::render
