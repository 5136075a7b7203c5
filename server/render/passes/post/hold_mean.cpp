#include "render/passes/post/hold_mean.hpp"

#include "render/kernels/signals.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "render/passes/reference/reference.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

void hold_mean(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef resolved,
               gpu::ImageRef mean, gpu::ImageRef mean_weight) {
  if (!in.settings.antialiasing.temporal) return;
  plan.pass("hold_mean", in.program(shaders::hold_mean))
      .bind<kernels::HoldMeanBindings>(
          {.mean = mean, .mean_weight = mean_weight, .resolved = resolved})
      .constants([in] {
        return kernels::HoldMeanConstants{size_of(in.shown), uniform_weight_constant(in)};
      })
      .when([in] {
        const auto most = static_cast<std::uint32_t>(in.settings.accumulation.max_samples);
        return !traces_reference(in) && in.clock.samples + 1 >= most && weighs_mean(in);
      })
      .dispatch(in.shown)
      .host(kernels::hold_mean);
}

}  // namespace heliograph::render
