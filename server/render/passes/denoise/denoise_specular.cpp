#include "render/passes/denoise/denoise_specular.hpp"

#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/denoise/temporal.hpp"
#include "render/passes/formats.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::four_floats;

gpu::ImageRef compress(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef noisy) {
  const auto compressed = plan.image(denoise_specular_buffers.compressed.name, four_floats);
  plan.pass("specular.compress", in.program(shaders::specular_compress))
      .read(noisy)
      .write(compressed)
      .constants([&s = in.settings.reinhard] { return s.multiplier; })
      .dispatch(gpu::each_pixel());
  return compressed;
}

gpu::ImageRef expand(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef compressed) {
  struct Constants {
    float multiplier;
    float paper_weight;
    std::uint32_t exact;
  };
  const auto expanded = plan.image(denoise_specular_buffers.expanded.name, four_floats);
  plan.pass("specular.expand", in.program(shaders::specular_expand))
      .read(compressed)
      .write(expanded)
      .constants([&s = in.settings.reinhard] {
        return Constants{s.multiplier, s.paper_weight, s.mode == protocol::Reinhard::exact};
      })
      .dispatch(gpu::each_pixel());
  return expanded;
}

AtrousConfig specular_atrous_config(const FrameInputs& in) {
  const auto& settings = in.settings.specular_blur;
  const auto constants = [in, &settings](const KernelShape& shape) {
    shared::AtrousConstants made = atrous_constants(settings, in.scene_motion, shape);
    made.start_threshold = settings.adapt_start ? settings.roughness_threshold : 2.0f;
    if (settings.lobe_limit) made.flags |= shared::atrous_lobe_limit;
    // Hits that only the environment lights have no noise of shadow rays.
    const bool noise_free_hits =
        in.settings.specular.hit_shading == protocol::HitShading::environment;
    if (settings.iterations_by_roughness && noise_free_hits) {
      made.flags |= shared::atrous_levels_by_roughness;
    }
    return made;
  };
  return radiance_atrous_config(in, "specular.atrous", specular_atrous_buffers, settings.iterations,
                                settings.kernel, constants);
}

}  // namespace

gpu::ImageRef denoise_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, const SampleHistories& histories,
                               gpu::ImageRef noisy) {
  const auto& blurring = in.settings.specular_blur;
  const bool feedback =
      blurring.enabled && blurring.feedback >= 0 && blurring.feedback < blurring.iterations;
  const bool tone_compressed = in.settings.reinhard.mode != protocol::Reinhard::off;

  gpu::ImageRef signal = tone_compressed ? compress(plan, in, noisy) : noisy;
  const RadianceChannel channel = specular_channel(in, histories);
  const AccumulatedSignal accumulated =
      accumulate_radiance(plan, in, gbuffer, guide, channel, signal);
  signal = accumulated.signal;
  if (blurring.enabled) {
    const auto feed_back = [&](gpu::ImageRef filtered) {
      feed_radiance_back(plan, in, channel, accumulated, filtered);
    };
    estimate_radiance_variance(plan, in, gbuffer, guide, channel, accumulated);
    signal = blur(plan, in, {guide.surface, gbuffer.depth_slope, accumulated.signal, guide.packed},
                  specular_atrous_config(in),
                  feedback ? std::optional(Feedback{blurring.feedback, feed_back}) : std::nullopt);
  }
  return tone_compressed ? expand(plan, in, signal) : signal;
}

}  // namespace heliograph::render
