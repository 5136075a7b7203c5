#include "render/passes/denoise/denoise_specular.hpp"

#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/denoise/temporal.hpp"
#include "render/passes/formats.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::four_floats;

gpu::ImageRef compress(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef raw) {
  const auto compressed = plan.image("specular.compressed", four_floats);
  plan.pass("specular.compress", in.programs.compute(shaders::specular_compress))
      .read(raw)
      .write(compressed)
      .constants([&s = in.settings.reinhard] { return s.multiplier; })
      .dispatch(plan.extent())
      .describe("Reflections of this frame under Reinhard's curve.");
  return compressed;
}

gpu::ImageRef expand(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef compressed) {
  struct Constants {
    float multiplier;
    float paper_weight;
    std::uint32_t exact;
  };
  const auto expanded = plan.image("specular.expanded", four_floats);
  plan.pass("specular.expand", in.programs.compute(shaders::specular_expand))
      .read(compressed)
      .write(expanded)
      .constants([&s = in.settings.reinhard] {
        return Constants{s.multiplier, s.paper_weight, s.mode == protocol::Reinhard::exact};
      })
      .dispatch(plan.extent())
      .describe("Denoised reflections as radiance again.");
  return expanded;
}

Blur specular_blur(const FrameInputs& in) {
  const auto& settings = in.settings.specular_blur;
  const auto constants = [in, &settings](const KernelShape& shape) {
    shared::AtrousConstants made = atrous_constants(settings, shape);
    made.start_threshold = settings.adapt_start ? settings.roughness_threshold : 2.0f;
    if (settings.lobe_limit) made.flags |= shared::atrous_lobe_limit;
    const bool quiet = in.settings.specular.hit_shading == protocol::HitShading::environment;
    if (settings.iterations_by_roughness && quiet) made.flags |= shared::atrous_levels_by_roughness;
    return made;
  };
  return {"specular",          in.programs.compute(shaders::specular_atrous),
          settings.iterations, settings.kernel,
          constants,           kernels::Signal::specular};
}

}  // namespace

gpu::ImageRef denoise_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, gpu::ImageRef raw) {
  const auto& blurring = in.settings.specular_blur;
  const bool feedback =
      blurring.enabled && blurring.feedback >= 0 && blurring.feedback < blurring.iterations;
  const bool curved = in.settings.reinhard.mode != protocol::Reinhard::off;

  gpu::ImageRef signal = curved ? compress(plan, in, raw) : raw;
  const Integrated integrated = accumulate_specular(plan, in, gbuffer, guide, signal, feedback);
  signal = integrated.signal;
  if (blurring.enabled) {
    estimate_specular_variance(plan, in, gbuffer, guide, integrated);
    signal = blur(plan, in, gbuffer, guide, specular_blur(in), integrated.signal,
                  feedback ? std::optional(Feedback{blurring.feedback, integrated.remembered})
                           : std::nullopt);
  }
  return curved ? expand(plan, in, signal) : signal;
}

}  // namespace heliograph::render
