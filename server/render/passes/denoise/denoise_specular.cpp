#include "render/passes/denoise/denoise_specular.hpp"

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

bool compresses(const FrameInputs& in) {
  return in.settings.reinhard.mode != protocol::Reinhard::off;
}

/// Reflections over the frames until this one, under Reinhard's curve where that is on.
AccumulatedSignal accumulate_specular(gpu::FramePlan& plan, const FrameInputs& in,
                                      const GBuffer& gbuffer, const Guide& guide,
                                      const RadianceChannel& channel, gpu::ImageRef noisy) {
  const gpu::ImageRef signal = compresses(in) ? compress(plan, in, noisy) : noisy;
  return accumulate_radiance(plan, in, gbuffer, guide, channel, signal);
}

}  // namespace

gpu::ImageRef denoise_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, const SampleHistories& histories,
                               gpu::ImageRef noisy) {
  const auto& blurring = in.settings.specular_blur;
  const RadianceChannel channel = specular_channel(in, histories);
  const AccumulatedSignal accumulated =
      accumulate_specular(plan, in, gbuffer, guide, channel, noisy);
  gpu::ImageRef signal = accumulated.signal;
  if (blurring.enabled) {
    const auto feed_back = [&](gpu::ImageRef filtered) {
      feed_radiance_back(plan, in, channel, accumulated, filtered);
    };
    estimate_radiance_variance(plan, in, gbuffer, guide, channel, accumulated);
    signal = blur(plan, in, {guide.surface, gbuffer.depth_slope, accumulated.signal, guide.packed},
                  specular_atrous_config(in),
                  feeds_back(blurring) ? std::optional(Feedback{blurring.feedback, feed_back})
                                       : std::nullopt);
  }
  return specular_of_blurred(plan, in, signal);
}

SignalBlur specular_to_blur(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                            const Guide& guide, const SampleHistories& histories,
                            gpu::ImageRef noisy) {
  const RadianceChannel channel = specular_channel(in, histories);
  const AccumulatedSignal accumulated =
      accumulate_specular(plan, in, gbuffer, guide, channel, noisy);
  estimate_radiance_variance(plan, in, gbuffer, guide, channel, accumulated);
  return {{guide.surface, gbuffer.depth_slope, accumulated.signal, guide.packed},
          specular_atrous_config(in)};
}

gpu::ImageRef specular_of_blurred(gpu::FramePlan& plan, const FrameInputs& in,
                                  gpu::ImageRef blurred) {
  return compresses(in) ? expand(plan, in, blurred) : blurred;
}

}  // namespace heliograph::render
