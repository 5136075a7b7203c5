#include "render/accumulate.hpp"

#include "render/frame.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

gpu::History accumulate(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef hdr) {
  const auto history = plan.history("accumulated", VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("accumulate", in.programs.compute(shaders::accumulate))
      .read(hdr)
      .read(history.previous)
      .write(history.current)
      .constants([&samples = in.samples] { return 1.0f / static_cast<float>(samples + 1); })
      .dispatch(plan.extent());
  return history;
}

}  // namespace heliograph::render
