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

std::optional<float> uniform_mean_weight(const FrameInputs& in) {
  if (!weighs_by_noise(in)) return mean_share(in);
  // One sample tells nothing of its noise.
  if (samples_of_mean(in) < 2) return 0.0f;
  return std::nullopt;
}

float uniform_weight_constant(const FrameInputs& in) {
  return uniform_mean_weight(in).value_or(-1.0f);
}

bool weighs_mean(const FrameInputs& in) {
  return uniform_mean_weight(in) != 0.0f;
}

gpu::ImageRef weigh_mean(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                         gpu::ImageRef radiance, gpu::ImageRef mean) {
  const auto weight =
      plan.image(mean_weight_buffers.weight.name, VK_FORMAT_R32_SFLOAT, 0, in.shown);
  plan.pass("mean_weight", in.program(shaders::mean_weight))
      .bind<kernels::MeanWeightBindings>(
          {.radiance = radiance, .mean = mean, .exposure = exposure.state, .weight = weight})
      .constants([in] { return kernels::MeanWeightConstants{size_of(in.shown)}; })
      .when([in] { return !uniform_mean_weight(in); })
      .dispatch(in.shown)
      .host(kernels::mean_weight);
  plan.leave_undefined_when_skipped(weight);
  return weight;
}

}  // namespace heliograph::render
