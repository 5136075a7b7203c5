#include "render/passes/post/filter_mean.hpp"

#include "render/kernels/post/filter_mean.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/post/accumulate.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "render/passes/reference/reference.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// How much larger than estimated the variance of a mean of few samples is taken to be: rare bright
/// samples are missing in most of the estimates. StaticView.NeverGetsWorse pins it.
constexpr float few_samples = 2.0f;
/// The same of the filtered mean: what is left of those samples is alike in neighbours.
constexpr float few_filtered_samples = 8.0f;
/// The same of path traced samples, beside the hybrid's mean, which is nearer to the truth than a
/// single frame: similarity must not fall. Found at 640x360 in the atrium and the breakfast room.
constexpr float few_traced_samples = 4.0f;

/// As many samples the variance of a pixel's surroundings is worth beside its own. With two samples
/// alike, a pixel would else seem free of noise: FilterMean.PixelsOfLikeSamplesAreNotFreeOfNoise.
constexpr float prior_samples = 2.0f;

kernels::FilterMeanConstants filter_constants(const FrameInputs& in) {
  const std::uint32_t samples = samples_of_mean(in);
  kernels::FilterMeanConstants constants{size_of(in.shown), 0.0f, 0.0f, 0.0f};
  if (samples < 2) return constants;
  const float fewer = 1.0f / static_cast<float>(samples - 1);
  constants.variance_scale = fewer * (1.0f + few_samples * fewer);
  constants.prior_share = prior_samples / (static_cast<float>(samples - 1) + prior_samples);
  if (in.settings.accumulation.filter && weighs_by_noise(in)) {
    constants.noise_scale = 1.0f + few_filtered_samples * fewer;
    if (traces_reference(in)) constants.noise_scale *= few_traced_samples;
  }
  return constants;
}

}  // namespace

gpu::ImageRef filter_mean(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                          gpu::ImageRef radiance, gpu::ImageRef mean) {
  const auto filtered =
      plan.image(filter_mean_buffers.filtered.name, VK_FORMAT_R16G16B16A16_SFLOAT, 0, in.shown);
  plan.pass("filter_mean", in.program(shaders::filter_mean))
      .bind<kernels::FilterMeanBindings>(
          {.radiance = radiance, .mean = mean, .exposure = exposure.state, .filtered = filtered})
      .constants([in] { return filter_constants(in); })
      .when([in] { return weighs_mean(in); })
      .dispatch(in.shown)
      .host(kernels::filter_mean);
  // The mean has no weight in such frames.
  plan.leave_undefined_when_skipped(filtered);
  return filtered;
}

}  // namespace heliograph::render
