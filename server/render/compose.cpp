#include "render/compose.hpp"

#include "render/frame.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

gpu::ImageRef compose(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                      gpu::ImageRef shadows, gpu::ImageRef ambient, gpu::ImageRef background) {
  const auto hdr = plan.image("hdr", VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("compose", in.programs.compute(shaders::compose))
      .read(gbuffer.normals)
      .read(gbuffer.base_color)
      .read(gbuffer.surface)
      .read(gbuffer.motion)
      .read(gbuffer.emissive)
      .read(shadows)
      .read(ambient)
      .read(background)
      .write(hdr)
      .dispatch(plan.extent());
  return hdr;
}

}  // namespace heliograph::render
