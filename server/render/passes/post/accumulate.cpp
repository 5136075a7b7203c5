#include "render/passes/post/accumulate.hpp"

#include <algorithm>

#include "render/kernels/signals.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/reference/reference.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Whether the frame differs from this frame's sample.
bool is_filtered(const protocol::Settings& settings) {
  return settings.shadow_temporal.enabled || settings.shadow_blur.enabled ||
         (settings.specular.enabled &&
          (settings.specular_temporal.enabled || settings.specular_blur.enabled)) ||
         settings.antialiasing.temporal ||
         settings.reference.use == protocol::ReferenceUse::when_static;
}

/// Samples in the mean, with this frame's.
std::uint32_t samples_of_mean(const FrameInputs& in) {
  const bool late = (in.settings.reference.use == protocol::ReferenceUse::when_static &&
                     in.settings.accumulation.blend_samples > 0) ||
                    !in.clock.first_counts;
  return late ? std::max(in.clock.samples, 1u) : in.clock.samples + 1;
}

}  // namespace

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

float mean_weight(const FrameInputs& in) {
  if (in.is_reduced()) return 0.0f;
  const protocol::Settings& settings = in.settings;
  if (settings.reference.use == protocol::ReferenceUse::always || !is_filtered(settings) ||
      settings.accumulation.blend_samples == 0) {
    return 1.0f;
  }
  // The first sample does not count: a moving view shows no noise of the mean.
  const auto samples = static_cast<float>(in.clock.samples);
  return samples / (samples + static_cast<float>(settings.accumulation.blend_samples));
}

}  // namespace heliograph::render
