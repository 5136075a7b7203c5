#include "render/passes/post/temporal_antialias.hpp"

#include "render/kernels/post/temporal_antialias.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/passes/reference/reference.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Whether a static view's frame has forgotten what was before but for a fiftieth: after four times
/// as many frames as count in it, where that is read at texels (`most_still` of the shader).
/// Earlier its mean would come to rest; StaticView.ChangesLessWhereNoiseDecides pins, on a GPU,
/// that it ends.
bool has_settled(const FrameInputs& in) {
  constexpr float frames = 4.0f * 4.0f;
  return static_cast<float>(in.clock.samples) >
         frames * (1.0f / in.settings.antialiasing.blend - 1.0f);
}

}  // namespace

gpu::ImageRef temporal_antialias(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Exposure& exposure,
                                 gpu::ImageRef radiance) {
  if (!in.settings.antialiasing.temporal) return radiance;
  const bool halves = formats::in_halves(plan);
  const auto history =
      plan.history(temporal_antialias_buffers.resolved.name,
                   halves ? formats::four_halves : formats::four_floats, 0, in.shown);
  plan.pass("temporal_antialias", in.program(shaders::temporal_antialias))
      .bind<kernels::AntialiasBindings>({.radiance = radiance,
                                         .motion = gbuffer.motion,
                                         .history = history.previous,
                                         .exposure = exposure.state,
                                         .resolved = history.current})
      .constants([in] {
        const protocol::Settings::Antialiasing& s = in.settings.antialiasing;
        return kernels::AntialiasConstants{
            size_of(in.shown),    s.blend,        s.clip, s.anti_flicker ? 1.0f : 0.0f,
            traces_reference(in), has_settled(in)};
      })
      .dispatch(in.shown)
      .host(kernels::temporal_antialias, in.constants);
  return history.current;
}

}  // namespace heliograph::render
