#include "render/present.hpp"

#include "render/frame.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

gpu::ImageRef present(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef radiance) {
  const auto picture = plan.image("output", VK_FORMAT_R8G8B8A8_UNORM);
  plan.pass("present", in.programs.compute(shaders::present)).read(radiance).write(picture).dispatch(plan.extent());
  return picture;
}

}  // namespace heliograph::render
