#include "render/passes/post/present.hpp"

#include "render/kernels/post/present.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

gpu::ImageRef present(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                      gpu::ImageRef radiance, gpu::ImageRef mean, gpu::ImageRef mean_weight) {
  const auto output =
      plan.image(present_buffers.output.name, VK_FORMAT_R8G8B8A8_UNORM, 0, in.shown);
  plan.pass("present", in.program(shaders::present))
      .bind<kernels::PresentBindings>({.radiance = radiance,
                                       .mean = mean,
                                       .mean_weight = mean_weight,
                                       .exposure = exposure.state,
                                       .output = output})
      .constants([in, &plan, radiance] {
        return kernels::PresentConstants{size_of(in.shown), size_of(plan.drawn(radiance)),
                                         uniform_weight_constant(in)};
      })
      .dispatch(in.shown)
      .host(kernels::present, in.constants);
  return output;
}

}  // namespace heliograph::render
