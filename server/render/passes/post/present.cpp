#include "render/passes/post/present.hpp"

#include "render/kernels/present.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/post/accumulate.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render {

gpu::ImageRef present(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                      gpu::ImageRef radiance, gpu::ImageRef mean) {
  const auto picture = plan.image("output", VK_FORMAT_R8G8B8A8_UNORM);
  const auto declare = [&] {
    if (!on_host(plan, in)) {
      return plan.pass("present", in.programs.compute(shaders::present))
          .constants([in] { return mean_share(in); })
          .dispatch(plan.extent());
    }
    return plan.host("present", [&plan, in, radiance, mean, picture, state = exposure.state] {
      const auto* now = reinterpret_cast<const shared::ExposureState*>(plan.get(state).mapped());
      kernels::present({.frame = in.constants,
                        .exposure = now->factor,
                        .mean_share = mean_share(in),
                        .width = static_cast<int>(plan.extent().width),
                        .height = static_cast<int>(plan.extent().height),
                        .radiance = plan.get(radiance).host(),
                        .accumulated = plan.get(mean).host(),
                        .picture = plan.get(picture).host()});
    });
  };
  declare()
      .read(radiance)
      .read(mean)
      .read(exposure.state)
      .write(picture)
      .describe("The finished picture, sRGB.");
  return picture;
}

}  // namespace heliograph::render
