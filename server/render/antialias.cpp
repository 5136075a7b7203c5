#include "render/antialias.hpp"

#include "render/frame.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

struct Constants {
  float blend;
  float clip;
  float anti_flicker;
};

}  // namespace

gpu::ImageRef temporal_antialias(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Exposure& exposure,
                                 gpu::ImageRef radiance) {
  if (!in.settings.antialiasing.temporal) return radiance;
  const auto history = plan.history("antialiased", VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("temporal_antialias", in.programs.compute(shaders::temporal_antialias))
      .read(radiance)
      .read(gbuffer.motion)
      .read(history.previous)
      .read(exposure.state)
      .write(history.current)
      .constants([&settings = in.settings.antialiasing] {
        return Constants{settings.blend, settings.clip, settings.anti_flicker ? 1.0f : 0.0f};
      })
      .dispatch(plan.extent())
      .describe("The frame blended with those before it (temporal antialiasing): linear radiance.");
  return history.current;
}

}  // namespace heliograph::render
