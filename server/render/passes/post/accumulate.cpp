#include "render/passes/post/accumulate.hpp"

#include <algorithm>

#include "render/kernels/signals.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/reference/reference.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Whether the frame alone is anything else than this frame's sample.
bool is_filtered(const protocol::Settings& settings) {
  return settings.shadow_temporal.enabled || settings.shadow_blur.enabled ||
         (settings.specular.enabled &&
          (settings.specular_temporal.enabled || settings.specular_blur.enabled)) ||
         settings.antialiasing.temporal ||
         settings.reference.use == protocol::ReferenceUse::when_static;
}

/// Samples in the mean when this frame's is in it.
std::uint32_t mean_of(const FrameInputs& in) {
  const bool late = in.settings.reference.use == protocol::ReferenceUse::when_static &&
                    in.settings.accumulation.blend_samples > 0;
  return late ? std::max(in.samples, 1u) : in.samples + 1;
}

}  // namespace

gpu::History accumulate(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef sample) {
  const auto history = plan.history("accumulated", VK_FORMAT_R32G32B32A32_SFLOAT);
  const auto weight = [in] { return 1.0f / static_cast<float>(mean_of(in)); };
  const auto declare = [&] {
    if (!on_host(plan, in)) {
      return plan.pass("accumulate", in.programs.compute(shaders::accumulate))
          .constants(weight)
          .dispatch(plan.extent());
    }
    return plan.host("accumulate", [&plan, weight, sample, history] {
      kernels::accumulate({.width = static_cast<int>(plan.extent().width),
                           .height = static_cast<int>(plan.extent().height),
                           .weight = weight(),
                           .sample = plan.get(sample).host(),
                           .previous = plan.get(history.previous).host(),
                           .mean = plan.get(history.current).host()});
    });
  };
  declare()
      .read(sample)
      .read(history.previous)
      .write(history.current)
      .describe("The mean of all samples since the picture last changed: linear radiance.");
  return history;
}

float mean_share(const FrameInputs& in) {
  const protocol::Settings& settings = in.settings;
  if (settings.reference.use == protocol::ReferenceUse::always || !is_filtered(settings) ||
      settings.accumulation.blend_samples == 0) {
    return 1.0f;
  }
  // The first sample does not count: what moves shows none of the mean's noise.
  const auto samples = static_cast<float>(in.samples);
  return samples / (samples + static_cast<float>(settings.accumulation.blend_samples));
}

}  // namespace heliograph::render
