#include "render/frame/frame.hpp"

#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/compose/compose.hpp"
#include "render/passes/compose/skybox.hpp"
#include "render/passes/denoise/denoise_specular.hpp"
#include "render/passes/denoise/denoise_visibility.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/post/accumulate.hpp"
#include "render/passes/post/present.hpp"
#include "render/passes/post/temporal_antialias.hpp"
#include "render/passes/reference/reference.hpp"
#include "render/passes/reflections/trace_specular.hpp"
#include "render/passes/visibility/trace_visibility.hpp"

namespace heliograph::render {
namespace {

/// The signals without noise, as far as the settings denoise them.
std::optional<DenoisedSignals> denoise(gpu::FramePlan& plan, const FrameInputs& in,
                                       const GBuffer& gbuffer, const NoisySignals& noisy) {
  const protocol::Settings& s = in.settings;
  const bool visibility = s.shadow_temporal.enabled || s.shadow_blur.enabled;
  const bool specular = noisy.specular && (s.specular_temporal.enabled || s.specular_blur.enabled);
  if (!visibility && !specular) return std::nullopt;
  const Guide guide = reproject(plan, in, gbuffer);
  DenoisedSignals denoised{combine_visibility(plan, in, noisy.shadows, noisy.ambient),
                           noisy.specular};
  if (visibility) {
    denoised.visibility = denoise_visibility(plan, in, gbuffer, guide, denoised.visibility);
  }
  if (specular) denoised.specular = denoise_specular(plan, in, gbuffer, guide, *noisy.specular);
  return denoised;
}

/// The path traced ground truth alone.
FrameOutputs declare_reference(gpu::FramePlan& plan, const FrameInputs& in) {
  const gpu::ImageRef sample = trace_reference(plan, in);
  const gpu::History accumulated = accumulate(plan, in, sample);
  const Exposure exposure = expose(plan, in, sample, accumulated.current);
  return {accumulated, exposure, sample, present(plan, in, exposure, sample, accumulated.current)};
}

}  // namespace

// The stages of the paper's section 3, in its order; the prefilter ran when the environment came.
FrameOutputs declare_frame(gpu::FramePlan& plan, const FrameInputs& in) {
  const protocol::ReferenceUse reference = in.settings.reference.use;
  if (reference == protocol::ReferenceUse::always) return declare_reference(plan, in);
  const GBuffer gbuffer =
      traces_gbuffer(plan.device(), in) ? trace_gbuffer(plan, in) : rasterize_gbuffer(plan, in);

  NoisySignals noisy{trace_shadows(plan, in, gbuffer), trace_ambient(plan, in, gbuffer), {}};
  if (in.settings.specular.enabled) noisy.specular = trace_specular(plan, in, gbuffer);
  const auto denoised = denoise(plan, in, gbuffer, noisy);

  const gpu::ImageRef background = draw_skybox(plan, in, gbuffer);
  const Composed composed = compose(plan, in, gbuffer, noisy, denoised, background);
  GBuffer visible = gbuffer;
  visible.motion = blend_surfaces(plan, in, gbuffer, composed);

  const bool traces_reference = reference == protocol::ReferenceUse::when_static;
  const gpu::History accumulated =
      accumulate(plan, in, traces_reference ? trace_reference(plan, in) : composed.noisy);
  const Exposure exposure = expose(plan, in, composed.hdr, accumulated.current);
  const gpu::ImageRef resolved = temporal_antialias(plan, in, visible, exposure, composed.hdr);
  const gpu::ImageRef output = present(plan, in, exposure, resolved, accumulated.current);
  return {accumulated, exposure, resolved, output};
}

}  // namespace heliograph::render
