#include "render/passes/denoise/denoise_indirect.hpp"

#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Its lobe is as wide as that of the roughest reflection.
AtrousConfig indirect_atrous_config(const FrameInputs& in) {
  const auto& settings = in.settings.indirect_blur;
  const auto constants = [in, &settings](const KernelShape& shape) {
    shared::AtrousConstants made = atrous_constants(settings, in.scene_motion, shape);
    made.start_threshold = settings.adapt_start ? -1.0f : 2.0f;
    return made;
  };
  return {"indirect.atrous",
          indirect_atrous_buffers,
          in.program(shaders::specular_atrous),
          kernels::specular_atrous,
          kernels::specular_atrous_halves,
          settings.iterations,
          settings.kernel,
          constants};
}

}  // namespace

gpu::ImageRef denoise_indirect(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, gpu::ImageRef noisy) {
  const auto& blurring = in.settings.indirect_blur;
  const bool feedback =
      blurring.enabled && blurring.feedback >= 0 && blurring.feedback < blurring.iterations;
  const RadianceChannel channel = indirect_channel(plan, in);
  const AccumulatedSignal accumulated =
      accumulate_radiance(plan, in, gbuffer, guide, channel, noisy);
  if (!blurring.enabled) return accumulated.signal;
  const auto feed_back = [&](gpu::ImageRef filtered) {
    feed_radiance_back(plan, in, channel, accumulated, filtered);
  };
  estimate_radiance_variance(plan, in, gbuffer, guide, channel, accumulated);
  return blur(plan, in, {guide.surface, gbuffer.depth_slope, accumulated.signal},
              indirect_atrous_config(in),
              feedback ? std::optional(Feedback{blurring.feedback, feed_back}) : std::nullopt);
}

}  // namespace heliograph::render
