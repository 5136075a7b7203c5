#include "render/passes/post/mean_weight.hpp"

#include "render/kernels/post/mean_weight.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/post/accumulate.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Whether the frame differs from this frame's sample.
bool is_filtered(const protocol::Settings& settings) {
  return denoises_visibility(settings) || denoises_specular(settings) ||
         denoises_indirect(settings) || settings.antialiasing.temporal ||
         settings.reference.use == protocol::ReferenceUse::when_static;
}

bool shows_mean_alone(const protocol::Settings& settings) {
  return settings.reference.use == protocol::ReferenceUse::always || !is_filtered(settings) ||
         settings.accumulation.blend_samples == 0;
}

}  // namespace

float mean_share(const FrameInputs& in) {
  if (in.is_reduced()) return 0.0f;
  if (shows_mean_alone(in.settings)) return 1.0f;
  // The first sample does not count: a moving view shows no noise of the mean.
  const auto samples = static_cast<float>(in.clock.samples);
  return samples / (samples + static_cast<float>(in.settings.accumulation.blend_samples));
}

bool weighs_by_noise(const FrameInputs& in) {
  return !in.is_reduced() && !shows_mean_alone(in.settings) && in.settings.accumulation.by_noise;
}

bool weighs_mean(const FrameInputs& in) {
  return weighs_by_noise(in) ? samples_of_mean(in) >= 2 : mean_share(in) > 0.0f;
}

gpu::ImageRef weigh_mean(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                         gpu::ImageRef radiance, gpu::ImageRef mean) {
  const auto weight =
      plan.image(mean_weight_buffers.weight.name, VK_FORMAT_R32_SFLOAT, 0, in.shown);
  plan.pass("mean_weight", in.program(shaders::mean_weight))
      .bind<kernels::MeanWeightBindings>(
          {.radiance = radiance, .mean = mean, .exposure = exposure.state, .weight = weight})
      .constants([in] {
        const bool by_noise = weighs_by_noise(in);
        // One sample tells nothing of its noise.
        const bool compared = by_noise && samples_of_mean(in) >= 2;
        return kernels::MeanWeightConstants{size_of(in.shown), by_noise ? 0.0f : mean_share(in),
                                            compared};
      })
      .dispatch(in.shown)
      .host(kernels::mean_weight);
  return weight;
}

}  // namespace heliograph::render
