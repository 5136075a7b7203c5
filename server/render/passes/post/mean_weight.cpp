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

/// How much larger than estimated the variance of a mean of few samples is taken to be: rare bright
/// samples are missing in most of the estimates. StaticView.NeverGetsWorse pins it.
constexpr float few_samples = 2.0f;

kernels::MeanWeightConstants weight_constants(const FrameInputs& in) {
  kernels::MeanWeightConstants constants{size_of(in.shown), mean_share(in), 0.0f};
  const protocol::Settings& settings = in.settings;
  if (in.is_reduced() || shows_mean_alone(settings) || !settings.accumulation.by_noise) {
    return constants;
  }
  constants.share = 0.0f;
  const std::uint32_t samples = samples_of_mean(in);
  if (samples < 2) return constants;
  const float fewer = 1.0f / static_cast<float>(samples - 1);
  constants.variance_scale = fewer * (1.0f + few_samples * fewer);
  return constants;
}

}  // namespace

float mean_share(const FrameInputs& in) {
  if (in.is_reduced()) return 0.0f;
  if (shows_mean_alone(in.settings)) return 1.0f;
  // The first sample does not count: a moving view shows no noise of the mean.
  const auto samples = static_cast<float>(in.clock.samples);
  return samples / (samples + static_cast<float>(in.settings.accumulation.blend_samples));
}

gpu::ImageRef weigh_mean(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                         gpu::ImageRef radiance, gpu::ImageRef mean) {
  const auto weight =
      plan.image(mean_weight_buffers.weight.name, VK_FORMAT_R32_SFLOAT, 0, in.shown);
  plan.pass("mean_weight", in.program(shaders::mean_weight))
      .bind<kernels::MeanWeightBindings>(
          {.radiance = radiance, .mean = mean, .exposure = exposure.state, .weight = weight})
      .constants([in] { return weight_constants(in); })
      .dispatch(in.shown)
      .host(kernels::mean_weight);
  return weight;
}

}  // namespace heliograph::render
