#include "render/passes/post/accumulate.hpp"

#include <algorithm>

#include "render/kernels/signals.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/reference/reference.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

std::uint32_t samples_of_mean(const FrameInputs& in) {
  const bool late = (in.settings.reference.use == protocol::ReferenceUse::when_static &&
                     in.settings.accumulation.blend_samples > 0) ||
                    !in.clock.first_counts;
  return late ? std::max(in.clock.samples, 1u) : in.clock.samples + 1;
}

gpu::History accumulate(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef sample) {
  const auto history = plan.history(accumulate_buffers.mean.name, VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("accumulate", in.program(shaders::accumulate))
      .bind<kernels::AccumulateBindings>(
          {.sample = sample, .previous = history.previous, .mean = history.current})
      .constants([in] {
        return kernels::AccumulateConstants{1.0f / static_cast<float>(samples_of_mean(in))};
      })
      .dispatch(gpu::each_pixel())
      .host(kernels::accumulate);
  return history;
}

}  // namespace heliograph::render
