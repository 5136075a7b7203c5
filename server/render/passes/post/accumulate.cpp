#include "render/passes/post/accumulate.hpp"

#include <algorithm>

#include "render/kernels/signals.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/reference/reference.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

std::uint32_t samples_of_mean(const FrameInputs& in) {
  if (in.clock.hybrid_samples) return in.clock.samples - *in.clock.hybrid_samples + 1;
  return in.clock.first_counts ? in.clock.samples + 1 : std::max(in.clock.samples, 1u);
}

gpu::History accumulate(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef sample,
                        const std::function<bool()>& when, std::optional<gpu::ImageRef> traced) {
  const auto history = plan.history(accumulate_buffers.mean.name, VK_FORMAT_R32G32B32A32_SFLOAT);
  const auto add = [&](gpu::ImageRef added) {
    plan.pass("accumulate", in.program(shaders::accumulate))
        .bind<kernels::AccumulateBindings>(
            {.sample = added, .previous = history.previous, .mean = history.current})
        .constants([in] {
          return kernels::AccumulateConstants{1.0f / static_cast<float>(samples_of_mean(in))};
        })
        .dispatch(gpu::each_pixel())
        .host(kernels::accumulate)
        .when(when);
  };
  plan.leave_undefined_when_skipped(history.current);
  if (!traced) {
    add(sample);
    return history;
  }
  plan.only_when([in] { return traces_reference(in); }, [&] { add(*traced); },
                 [&] { add(sample); });
  return history;
}

}  // namespace heliograph::render
