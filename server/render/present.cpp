#include "render/present.hpp"

#include "render/accumulate.hpp"
#include "render/frame.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

gpu::ImageRef present(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                      gpu::ImageRef radiance, gpu::ImageRef mean) {
  const auto picture = plan.image("output", VK_FORMAT_R8G8B8A8_UNORM);
  plan.pass("present", in.programs.compute(shaders::present))
      .read(radiance)
      .read(mean)
      .read(exposure.state)
      .write(picture)
      .constants([in] { return mean_share(in); })
      .dispatch(plan.extent())
      .describe("The finished picture, sRGB.");
  return picture;
}

}  // namespace heliograph::render
