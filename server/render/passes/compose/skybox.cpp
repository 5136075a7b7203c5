#include "render/passes/compose/skybox.hpp"

#include "render/kernels/skybox.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

SeenBackground::SeenBackground(const FrameInputs& in)
    : chosen_(in.moving.environment().background(in.settings.background)), moving_(in.moving) {}

/// The environment is seen as it was read: with its sun.
kernels::RadianceMap SeenBackground::map() const {
  return kernels::view_map(chosen_ ? chosen_->map : *moving_.environment().source());
}

gpu::ImageRef draw_skybox(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                          const std::function<bool()>& when) {
  const auto background = plan.image(skybox_buffers.radiance.name, VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("skybox", in.program(shaders::skybox))
      .bind<kernels::SkyboxBindings>({.motion = gbuffer.motion, .background = background})
      .dispatch(gpu::each_pixel())
      .host([in, seen = SeenBackground(in)](const kernels::SkyboxJob::Pass& pass) {
        kernels::skybox({pass, in.constants, seen.map()});
      })
      .when(when);
  plan.ignore_when_skipped(background);  // then compose() looks up what is seen
  return background;
}

}  // namespace heliograph::render
