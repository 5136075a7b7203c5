#include "render/passes/post/temporal_antialias.hpp"

#include "render/kernels/temporal_antialias.hpp"
#include "render/passes/frame_inputs.hpp"
#include "shaders/embedded.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render {
namespace {

struct Constants {
  float blend;
  float clip;
  float anti_flicker;
};

/// The shader, or its twin where the device's memory is the host's.
gpu::PassBuilder declare_pass(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef radiance,
                              gpu::ImageRef motion, const gpu::History& history,
                              gpu::BufferRef exposure) {
  const auto& settings = in.settings.antialiasing;
  if (!on_host(plan, in)) {
    return plan.pass("temporal_antialias", in.programs.compute(shaders::temporal_antialias))
        .constants([&settings] {
          return Constants{settings.blend, settings.clip, settings.anti_flicker ? 1.0f : 0.0f};
        })
        .dispatch(plan.extent());
  }
  return plan.host("temporal_antialias", [=, &plan, &settings, &frame = in.constants] {
    const auto view = [&plan](gpu::ImageRef image) { return plan.get(image).host(); };
    const auto* state = reinterpret_cast<const shared::ExposureState*>(plan.get(exposure).mapped());
    kernels::temporal_antialias({.frame = frame,
                                 .blend = settings.blend,
                                 .clip = settings.clip,
                                 .anti_flicker = settings.anti_flicker,
                                 .exposure = state->factor,
                                 .width = static_cast<int>(plan.extent().width),
                                 .height = static_cast<int>(plan.extent().height),
                                 .radiance = view(radiance),
                                 .motion = view(motion),
                                 .history = view(history.previous),
                                 .resolved = view(history.current)});
  });
}

}  // namespace

gpu::ImageRef temporal_antialias(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Exposure& exposure,
                                 gpu::ImageRef radiance) {
  if (!in.settings.antialiasing.temporal) return radiance;
  const auto history = plan.history("antialiased", VK_FORMAT_R32G32B32A32_SFLOAT);
  declare_pass(plan, in, radiance, gbuffer.motion, history, exposure.state)
      .read(radiance)
      .read(gbuffer.motion)
      .read(history.previous)
      .read(exposure.state)
      .write(history.current)
      .describe("The frame blended with those before it (temporal antialiasing): linear radiance.");
  return history.current;
}

}  // namespace heliograph::render
