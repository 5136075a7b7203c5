#include "render/frame/frame.hpp"

#include <functional>

#include "render/passes/blend/blend_surfaces.hpp"
#include "render/passes/compose/compose.hpp"
#include "render/passes/compose/skybox.hpp"
#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/denoise_indirect.hpp"
#include "render/passes/denoise/denoise_specular.hpp"
#include "render/passes/denoise/denoise_visibility.hpp"
#include "render/passes/gbuffer/draw_gbuffer.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/ground/ground.hpp"
#include "render/passes/indirect/trace_indirect.hpp"
#include "render/passes/post/accumulate.hpp"
#include "render/passes/post/defocus.hpp"
#include "render/passes/post/filter_mean.hpp"
#include "render/passes/post/hold_mean.hpp"
#include "render/passes/post/mean_weight.hpp"
#include "render/passes/post/outline_selection.hpp"
#include "render/passes/post/present.hpp"
#include "render/passes/post/temporal_antialias.hpp"
#include "render/passes/reference/reference.hpp"
#include "render/passes/reflections/trace_specular.hpp"
#include "render/passes/sampling/plan_samples.hpp"
#include "render/passes/visibility/trace_visibility.hpp"
#include "render/resources/ground_plane.hpp"

namespace heliograph::render {
namespace {

/// By the method that suits the device, unless the settings name one.
GBuffer find_surfaces(gpu::FramePlan& plan, const FrameInputs& in, const BlendedImages* blended) {
  if (draws_gbuffer_on_host(plan, in)) return draw_gbuffer(plan, in, blended);
  return traces_gbuffer(plan.device(), in) ? trace_gbuffer(plan, in) : rasterize_gbuffer(plan, in);
}

/// Where surfaces were in the frame before, and which of them are sampled in this one.
struct Reprojected {
  Guide guide;
  SampleHistories histories;
  gpu::ImageRef planned;
};

Reprojected reproject_and_plan(gpu::FramePlan& plan, const FrameInputs& in,
                               const GBuffer& gbuffer) {
  const Guide guide = reproject(plan, in, gbuffer);
  const SampleHistories histories = declare_sample_histories(plan, in.settings);
  PreviousSamples previous{histories.visibility_length.previous,
                           histories.specular_length.previous,
                           histories.specular.previous,
                           histories.visibility.previous,
                           {}};
  if (histories.indirect_length) previous.indirect_length = histories.indirect_length->previous;
  return {guide, histories, plan_samples(plan, in, gbuffer, guide, previous)};
}

/// Whether a frame traces shadows or ambient occlusion.
auto traces_visibility(const FrameInputs& in) {
  return [&frame = in.constants] {
    return (frame.flags & shared::frame_shadows) != 0 || shared::traces_ambient(frame.flags);
  };
}

/// Whether passes for both blur visibility and reflections.
bool blurs_together(const gpu::FramePlan& plan, const protocol::Settings& settings) {
  return denoises_visibility(settings) && denoises_specular(settings) &&
         !settings.shadow_blur.half_resolution &&
         can_blur_together(plan, settings.shadow_blur, settings.specular_blur);
}

/// Those of which more is read than what they show.
std::function<bool()> whole_frames(const FrameInputs& in) {
  return [in] { return !is_only_shown(in); };
}

/// Visibility and reflections without noise, where blurs_together().
void denoise_together(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                      const Reprojected& from, const NoisySignals& noisy,
                      DenoisedSignals& denoised) {
  std::optional<SignalBlur> visibility;
  plan.only_when(traces_visibility(in), [&] {
    const gpu::ImageRef combined =
        combine_visibility(plan, in, noisy.shadows, noisy.ambient, whole_frames(in));
    visibility.emplace(visibility_to_blur(plan, in, gbuffer, from.guide, from.histories, combined));
  });
  const SignalBlur specular =
      specular_to_blur(plan, in, gbuffer, from.guide, from.histories, *noisy.specular);
  const BlurredPair blurred = blur_together(plan, in, *visibility, specular, traces_visibility(in));
  denoised.visibility = blurred.visibility;
  denoised.specular = specular_of_blurred(plan, in, blurred.specular);
}

/// Each without the other's.
void denoise_apart(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                   const Reprojected& from, const NoisySignals& noisy, DenoisedSignals& denoised) {
  // Visibility that is not traced is not read either.
  plan.only_when(traces_visibility(in), [&] {
    denoised.visibility =
        combine_visibility(plan, in, noisy.shadows, noisy.ambient, whole_frames(in));
    if (!denoises_visibility(in.settings)) return;
    denoised.visibility =
        denoise_visibility(plan, in, gbuffer, from.guide, from.histories, denoised.visibility);
  });
  if (denoises_specular(in.settings)) {
    denoised.specular =
        denoise_specular(plan, in, gbuffer, from.guide, from.histories, *noisy.specular);
  }
}

/// The signals without noise, as far as the settings denoise them.
DenoisedSignals denoise(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                        const Reprojected& from, const NoisySignals& noisy) {
  DenoisedSignals denoised{{}, noisy.specular, noisy.indirect};
  if (blurs_together(plan, in.settings)) {
    denoise_together(plan, in, gbuffer, from, noisy, denoised);
  } else {
    denoise_apart(plan, in, gbuffer, from, noisy, denoised);
  }
  if (denoises_indirect(in.settings)) {
    denoised.indirect =
        denoise_indirect(plan, in, gbuffer, from.guide, from.histories, *noisy.indirect);
  }
  return denoised;
}

/// A path traced sample in frames of static views whose hybrid samples are complete; it has no
/// content in others.
gpu::ImageRef trace_reference_when_due(gpu::FramePlan& plan, const FrameInputs& in,
                                       gpu::BufferRef ground) {
  gpu::ImageRef traced;
  plan.only_when([in] { return traces_reference(in); },
                 [&] { traced = trace_reference(plan, in, ground); });
  plan.leave_undefined_when_skipped(traced);
  return traced;
}

/// The background is an image of its own where it holds shadows, and on processors, whose kernels
/// look it up for whole rows.
ComposeConditions when_not_only_shown(const gpu::FramePlan& plan, const FrameInputs& in) {
  const auto whole = whole_frames(in);
  if (plan.device().is_cpu() || catches_shadows(in.settings, in.moving)) return {{}, whole};
  return {whole, whole};
}

/// Blends the frame with the mean of its samples.
FrameOutputs show(gpu::FramePlan& plan, const FrameInputs& in, const gpu::History& accumulated,
                  const Exposure& exposure, gpu::ImageRef radiance) {
  const gpu::ImageRef mean = filter_mean(plan, in, exposure, radiance, accumulated.current);
  const gpu::ImageRef weight = weigh_mean(plan, in, exposure, radiance, mean);
  const gpu::ImageRef output = present(plan, in, exposure, radiance, mean, weight);
  return {accumulated, exposure, radiance, mean, weight, output};
}

/// The path traced ground truth alone.
FrameOutputs declare_reference(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground) {
  const gpu::ImageRef sample = trace_reference(plan, in, ground);
  const gpu::History accumulated = accumulate(plan, in, sample);
  const Exposure exposure = expose(plan, in, sample, accumulated.current);
  return show(plan, in, accumulated, exposure, sample);
}

}  // namespace

bool is_only_shown(const FrameInputs& in) {
  return !in.all_buffers && leaves_samples_out(in) && !weighs_mean(in);
}

// The stages of the paper's section 3, in its order; the prefilter ran when the environment came.
FrameOutputs declare_frame(gpu::FramePlan& plan, const FrameInputs& in) {
  const protocol::ReferenceUse reference = in.settings.reference.use;
  const gpu::BufferRef ground = trace_ground(plan, in);
  if (reference == protocol::ReferenceUse::always) return declare_reference(plan, in, ground);
  // First, so that what its passes need is free for the hybrid's.
  const bool takes_over = reference == protocol::ReferenceUse::when_static;
  std::optional<gpu::ImageRef> traced;
  if (takes_over) traced = trace_reference_when_due(plan, in, ground);
  // The host's rasteriser finds blended surfaces together with those behind them.
  std::optional<BlendedImages> drawn;
  if (has_blends(in) && draws_gbuffer_on_host(plan, in)) drawn = declare_blended(plan);
  const BlendedImages* const blended = drawn ? &*drawn : nullptr;
  const GBuffer gbuffer = find_surfaces(plan, in, blended);

  std::optional<Reprojected> from;
  std::optional<gpu::ImageRef> planned;
  if (denoises_specular(in.settings) || denoises_indirect(in.settings)) {
    from = reproject_and_plan(plan, in, gbuffer);
  } else if (denoises_visibility(in.settings)) {
    plan.only_when(traces_visibility(in), [&] { from = reproject_and_plan(plan, in, gbuffer); });
  }
  if (from) planned = from->planned;
  NoisySignals noisy{
      trace_shadows(plan, in, gbuffer, planned), trace_ambient(plan, in, gbuffer, planned), {}, {}};
  std::optional<RadianceCache> cache;
  if (in.settings.indirect.enabled) {
    cache = update_radiance_cache(plan, in);
    noisy.indirect = trace_indirect(plan, in, gbuffer, *cache, planned);
  }
  if (in.settings.specular.enabled) {
    std::optional<gpu::ImageRef> visibility;
    if (from) visibility = from->histories.visibility.previous;
    noisy.specular = trace_specular(plan, in, gbuffer, planned, visibility, cache);
  }
  std::optional<DenoisedSignals> denoised;
  if (from) denoised = denoise(plan, in, gbuffer, *from, noisy);

  // What is left takes little time, unless it traces rays.
  if ((in.moving.features_without_emission() & shared::scene_blends) == 0)
    plan.finish_frames_from_here();
  const ComposeConditions when = when_not_only_shown(plan, in);
  const gpu::ImageRef background = draw_skybox(plan, in, gbuffer, when.has_background);
  shade_ground(plan, in, gbuffer, ground, background);
  const Composed sharp = compose(plan, in, gbuffer, noisy, denoised, background, when);
  GBuffer visible = gbuffer;
  visible.motion = blend_surfaces(plan, in, gbuffer, sharp, cache, blended);
  const Composed composed = defocus(plan, in, gbuffer, sharp);

  const gpu::History accumulated =
      accumulate(plan, in, composed.noisy, composed.makes_noisy, traced);
  const Exposure exposure = expose(plan, in, composed.hdr, accumulated.current);
  const gpu::ImageRef resolved = temporal_antialias(plan, in, visible, exposure, composed.hdr);
  FrameOutputs outputs = show(plan, in, accumulated, exposure, resolved);
  outline_selection(plan, in, gbuffer.instance, outputs.output);
  if (takes_over) hold_mean(plan, in, resolved, outputs.mean, outputs.mean_weight);
  outputs.radiance_cache = cache;
  return outputs;
}

}  // namespace heliograph::render
