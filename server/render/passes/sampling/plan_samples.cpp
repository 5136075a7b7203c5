#include "render/passes/sampling/plan_samples.hpp"

#include "render/kernels/sampling/sampling_plan.hpp"
#include "render/kernels/temporal.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/resources/moving/scene_motion.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using protocol::Settings;

/// Rectification by the current frame's neighbourhood needs a sample of every pixel of it.
bool keeps_without_sample(const protocol::TemporalSettings& temporal) {
  return temporal.enabled &&
         kernels::can_accumulate(static_cast<std::uint32_t>(temporal.rectification));
}

bool plans_visibility(const Settings& s) {
  return s.sampling.visibility && keeps_without_sample(s.shadow_temporal);
}

bool plans_indirect(const Settings& s) {
  return s.sampling.visibility && s.indirect.enabled && keeps_without_sample(s.indirect_temporal);
}

bool plans_specular(const Settings& s) {
  return s.sampling.specular && s.specular.enabled && !s.specular.half_resolution &&
         keeps_without_sample(s.specular_temporal);
}

shared::SamplingPlanConstants plan_constants(const FrameInputs& in) {
  const Settings& s = in.settings;
  const std::uint32_t most =
      in.scene_motion.settled() ? static_cast<std::uint32_t>(s.sampling.floor) : 1u;
  const std::uint32_t mirrors = std::min(most, 2u);
  const auto at_most = [](std::uint32_t frames, bool planned) { return planned ? frames : 1u; };
  const bool fades = plans_specular(s) && in.scene_motion.settled();
  const bool looks_up = s.specular.fade_to == protocol::FadedReflection::environment;
  const bool gathers = denoises_indirect(s);
  const bool gathers_by_squares = gathers && s.indirect.half_resolution;
  // Roughness is stored in steps of 1 / 255.
  const float fade_range = std::max(s.specular.fade_end - s.specular.fade_start, 1.0f / 255.0f);
  return {static_cast<float>(s.sampling.full_frames),
          at_most(most, plans_visibility(s)),
          s.indirect.enabled ? at_most(gathers_by_squares ? 2 * most : most, plans_indirect(s))
                             : at_most(most, plans_visibility(s)),
          gathers_by_squares && plans_indirect(s) && !in.clock.is_young() ? 4u : 1u,
          !gathers                     ? 0u
          : s.indirect.half_resolution ? 2u
                                       : 1u,
          at_most(most, plans_specular(s)),
          at_most(mirrors, plans_specular(s)),
          s.specular.fade_start,
          1.0f / fade_range,
          fades ? s.specular.fade_fraction : 0.0f,
          looks_up ? shared::plan_specular | shared::plan_environment : 0u};
}

/// Whether frames of a moving view do.
bool may_leave_samples_out(const Settings& settings) {
  return (plans_visibility(settings) || plans_specular(settings)) &&
         settings.accumulation.blend_samples > 0 &&
         settings.reference.use != protocol::ReferenceUse::always;
}

}  // namespace

bool leaves_samples_out(const FrameInputs& in) {
  return in.clock.samples == 0 && in.constants.history_invalid == 0 &&
         may_leave_samples_out(in.settings);
}

bool leaves_visibility_out(const FrameInputs& in) {
  return leaves_samples_out(in) && plans_visibility(in.settings) && in.scene_motion.settled();
}

gpu::ImageRef plan_samples(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                           const Guide& guide, const PreviousSamples& previous) {
  const auto planned = plan.image(sampling_plan_buffers.plan.name, VK_FORMAT_R32_UINT);
  plan.pass("sampling.plan", in.program(shaders::sampling_plan))
      .bind<kernels::SamplingPlanBindings>(
          {.reprojection = guide.reprojection,
           .surface = gbuffer.surface,
           .visibility_length = previous.visibility_length,
           .specular_length = previous.specular_length,
           .specular_distance = previous.specular_distance,
           .visibility = previous.visibility,
           .indirect_length = previous.indirect_length.value_or(previous.visibility_length),
           .planned = planned})
      .constants([in] { return plan_constants(in); })
      .dispatch(gpu::each_pixel())
      .host(kernels::sampling_plan, in.constants)
      .when([in] { return leaves_samples_out(in); });
  return planned;
}

}  // namespace heliograph::render
