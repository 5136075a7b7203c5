#include "render/passes/denoise/temporal.hpp"

#include <limits>

#include "render/kernels/spatial_variance.hpp"
#include "render/kernels/temporal.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/formats.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::four_floats;
using formats::four_fractions;
using formats::four_halves;

/// The spread of brightness in every tile of 8x8 pixels of `noisy`, for the rectification that
/// needs it; otherwise any image, which is bound and not read.
gpu::ImageRef measure_percentiles(gpu::FramePlan& plan, const Guide& guide, gpu::ImageRef noisy,
                                  const BufferDescription& buffer, gpu::ProgramSource program,
                                  protocol::Rectification rectification) {
  if (rectification != protocol::Rectification::percentile) return guide.reprojection;
  const auto percentiles = plan.image(buffer.name, four_floats, 0, gpu::FrameSize::squares(8));
  plan.pass(std::string(buffer.name), std::move(program))
      .read(guide.surface)
      .read(noisy)
      .write(percentiles)
      .dispatch(gpu::each_pixel());
  return percentiles;
}

bool kernels_know(protocol::Rectification rectification) {
  return kernels::can_accumulate(static_cast<std::uint32_t>(rectification));
}

/// The gradient's changes are of one frame: they need no previous image. `bound` is, where there is
/// one of the format, and not read.
gpu::History declare_fast_history(gpu::FramePlan& plan, const BufferDescription& buffer,
                                  VkFormat format, protocol::Rectification rectification,
                                  std::optional<gpu::ImageRef> bound) {
  if (rectification != protocol::Rectification::gradient) return plan.history(buffer.name, format);
  const gpu::ImageRef changes = plan.image(buffer.name, format);
  return {changes, bound.value_or(changes)};
}

/// Whether a pass of its own rectifies, after accumulation.
bool rectifies_after(protocol::Rectification mode) {
  return mode == protocol::Rectification::fast_history || mode == protocol::Rectification::gradient;
}

}  // namespace

SampleHistories declare_sample_histories(gpu::FramePlan& plan, const protocol::Settings& settings) {
  std::optional<gpu::History> indirect_length;
  if (denoises_indirect(settings)) {
    const auto size = gpu::FrameSize::squares(settings.indirect.half_resolution ? 2 : 1);
    indirect_length =
        plan.history(indirect_temporal_buffers.history_length.name, four_halves, 0, size);
  }
  return {plan.history(visibility_temporal_buffers.history.name, four_fractions),
          plan.history(visibility_temporal_buffers.history_length.name, four_halves),
          plan.history(specular_temporal_buffers.history.name, four_halves),
          plan.history(specular_temporal_buffers.history_length.name, four_halves),
          indirect_length};
}

AccumulatedSignal accumulate_visibility(gpu::FramePlan& plan, const FrameInputs& in,
                                        const Guide& guide, const SampleHistories& histories,
                                        gpu::ImageRef noisy) {
  const auto& buffers = visibility_temporal_buffers;
  const gpu::History history = histories.visibility;
  const gpu::History moments = plan.history(buffers.moments.name, four_fractions);
  const gpu::History history_length = histories.visibility_length;
  const gpu::ImageRef signal = plan.image(buffers.signal.name, four_floats);
  plan.ignore_when_skipped(signal);  // then it is not blurred
  const auto& settings = in.settings.shadow_temporal;
  const gpu::History fast_history = declare_fast_history(
      plan, buffers.fast_history, formats::two_halves, settings.rectification, std::nullopt);
  const auto constants = [in, &settings] { return temporal_constants(in, settings); };
  const gpu::ImageRef percentiles =
      measure_percentiles(plan, guide, noisy, buffers.percentiles,
                          in.program(shaders::visibility_percentiles), settings.rectification);

  plan.pass("visibility.temporal", in.program(shaders::visibility_temporal))
      .bind<kernels::TemporalVisibilityBindings>(
          {.noisy = noisy,
           .guide = guide.surface,
           .reprojection = guide.reprojection,
           .previous_history = history.previous,
           .previous_moments = moments.previous,
           .previous_history_length = history_length.previous,
           .previous_fast_history = fast_history.previous,
           .percentiles = percentiles,
           .signal = signal,
           .history = history.current,
           .moments = moments.current,
           .history_length = history_length.current,
           .fast_history = fast_history.current})
      .constants(constants)
      .dispatch(gpu::each_pixel())
      .host(kernels::visibility_temporal, in.constants)
      .host_when(kernels_know(settings.rectification));
  if (rectifies_after(settings.rectification)) {
    plan.pass("visibility.rectify", in.program(shaders::visibility_rectify))
        .bind<kernels::RectifyBindings>({.guide = guide.surface,
                                         .fast_history = fast_history.current,
                                         .signal = signal,
                                         .history_length = history_length.current,
                                         .history = history.current})
        .constants(constants)
        .dispatch(gpu::each_pixel())
        .host(kernels::visibility_rectify, in.constants)
        // Visibility does not depend on the view: it changes only where geometry or lights move.
        .when([&settings, &motion = in.scene_motion] {
          return settings.rectification != protocol::Rectification::gradient ||
                 motion.geometry_moved;
        });
  }
  return {signal, moments.current, history_length.current, fast_history.current, history.current};
}

AccumulatedSignal accumulate_radiance(gpu::FramePlan& plan, const FrameInputs& in,
                                      const GBuffer& gbuffer, const Guide& guide,
                                      const RadianceChannel& channel, gpu::ImageRef noisy) {
  const RadianceTemporalBuffers& buffers = channel.buffers;
  const gpu::History history = channel.history;
  const gpu::History history_length = channel.history_length;
  const gpu::ImageRef signal = plan.image(buffers.signal.name, four_floats);
  const auto& settings = channel.settings;
  const gpu::History fast_history = declare_fast_history(plan, buffers.fast_history, four_halves,
                                                         settings.rectification, history.previous);
  const auto constants = [in, &settings, flags = channel.flags, most = channel.most_frames] {
    shared::TemporalConstants made = temporal_constants(in, settings);
    made.flags |= flags();
    made.frames = std::min(made.frames, most());
    return made;
  };
  const gpu::ImageRef percentiles =
      measure_percentiles(plan, guide, noisy, buffers.percentiles,
                          in.program(shaders::specular_percentiles), settings.rectification);

  plan.pass(channel.name + ".temporal", in.program(shaders::specular_temporal))
      .bind<kernels::TemporalSpecularBindings>({.noisy = noisy,
                                                .guide = guide.surface,
                                                .instance = gbuffer.instance,
                                                .reprojection = guide.reprojection,
                                                .previous_normals = gbuffer.previous_normals,
                                                .previous_surface = gbuffer.previous_surface,
                                                .previous_instance = gbuffer.previous_instance,
                                                .previous_history = history.previous,
                                                .previous_history_length = history_length.previous,
                                                .previous_fast_history = fast_history.previous,
                                                .percentiles = percentiles,
                                                .signal = signal,
                                                .history = history.current,
                                                .history_length = history_length.current,
                                                .fast_history = fast_history.current})
      .constants(constants)
      .dispatch(gpu::each_pixel())
      .host(kernels::specular_temporal, in.constants)
      .host_when(kernels_know(settings.rectification));
  if (rectifies_after(settings.rectification)) {
    plan.pass(channel.name + ".rectify", in.program(shaders::specular_rectify))
        .bind<kernels::RectifyBindings>({.guide = guide.surface,
                                         .fast_history = fast_history.current,
                                         .signal = signal,
                                         .history_length = history_length.current,
                                         .history = history.current})
        .constants(constants)
        .dispatch(gpu::each_pixel())
        .host(kernels::specular_rectify, in.constants)
        .when([&settings, rectifies = channel.rectifies] {
          return settings.rectification != protocol::Rectification::gradient || rectifies();
        });
  }
  return {signal, history_length.current, history_length.current, fast_history.current,
          history.current};
}

RadianceChannel specular_channel(const FrameInputs& in, const SampleHistories& histories) {
  const auto& settings = in.settings.specular_temporal;
  return {.name = "specular",
          .buffers = specular_temporal_buffers,
          .settings = settings,
          .history = histories.specular,
          .history_length = histories.specular_length,
          .flags =
              [&settings] {
                return (settings.virtual_motion ? shared::temporal_virtual_motion : 0u) |
                       (settings.curved_reflectors ? shared::temporal_curved_reflectors : 0u);
              },
          .most_frames = [] { return std::numeric_limits<float>::max(); },
          // A static view's second frame is the first that samples every pixel.
          .rectifies = [&clock = in.clock] { return clock.samples <= 1; }};
}

RadianceChannel indirect_channel(gpu::FramePlan& plan, const FrameInputs& in,
                                 const SampleHistories& histories) {
  const auto& buffers = indirect_temporal_buffers;
  // The first frames know few bounces: the later half of all is enough, and so it is after a change
  // of lights. Light that goes on to change, or that objects let in or shut out, lags by half of
  // `moving_seconds` behind the cache.
  const auto most_frames = [&clock = in.clock, &motion = in.scene_motion] {
    constexpr std::uint32_t least_frames = 4;
    constexpr float moving_seconds = 0.25f;
    const auto known =
        static_cast<float>(std::max(motion.frames_of_light(clock.age) / 2, least_frames));
    if (motion.settled() || clock.seconds <= 0.0f) return known;
    return std::min(known, std::max(moving_seconds / clock.seconds, float(least_frames)));
  };
  return {.name = "indirect",
          .buffers = buffers,
          .settings = in.settings.indirect_temporal,
          .history = plan.history(buffers.history.name, four_halves),
          .history_length = *histories.indirect_length,
          .flags = [] { return 0u; },
          .most_frames = most_frames,
          // It does not depend on the view: it changes only where geometry or lights do.
          .rectifies = [&motion = in.scene_motion] { return !motion.settled(); }};
}

void feed_visibility_back(gpu::FramePlan& plan, const FrameInputs& in,
                          const AccumulatedSignal& visibility, gpu::ImageRef filtered) {
  plan.pass("visibility.feedback", in.program(shaders::visibility_feedback))
      .bind<kernels::VisibilityFeedbackBindings>(
          {.filtered = filtered, .history = visibility.history})
      .dispatch(gpu::each_pixel())
      .host(kernels::visibility_feedback, in.constants);
}

void feed_radiance_back(gpu::FramePlan& plan, const FrameInputs& in, const RadianceChannel& channel,
                        const AccumulatedSignal& specular, gpu::ImageRef filtered) {
  plan.pass(channel.name + ".feedback", in.program(shaders::specular_feedback))
      .bind<kernels::SpecularFeedbackBindings>({.filtered = filtered,
                                                .fast_history = specular.fast_history,
                                                .history = specular.history})
      .dispatch(gpu::each_pixel())
      .host(kernels::specular_feedback, in.constants);
}

namespace {

gpu::PassBuilder variance_pass(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, const AccumulatedSignal& accumulated,
                               std::optional<gpu::ImageRef> history, const std::string& name,
                               gpu::ProgramSource program, const auto& settings) {
  gpu::PassBuilder pass = plan.pass(name, std::move(program));
  pass.bind<kernels::SpatialVarianceBindings>({.guide = guide.surface,
                                               .depth_slope = gbuffer.depth_slope,
                                               .moments = accumulated.moments,
                                               .history_length = accumulated.history_length,
                                               .signal = accumulated.signal,
                                               .history = history})
      .constants([in, &settings] { return temporal_constants(in, settings); })
      .dispatch(gpu::each_pixel())
      .when([&settings] { return settings.spatial_variance_frames > 0; });
  return pass;
}

}  // namespace

void estimate_visibility_variance(gpu::FramePlan& plan, const FrameInputs& in,
                                  const GBuffer& gbuffer, const Guide& guide,
                                  const AccumulatedSignal& visibility) {
  variance_pass(plan, in, gbuffer, guide, visibility, visibility.history, "visibility.variance",
                in.program(shaders::visibility_variance), in.settings.shadow_temporal)
      .host(kernels::visibility_variance, in.constants);
}

void estimate_radiance_variance(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                                const Guide& guide, const RadianceChannel& channel,
                                const AccumulatedSignal& radiance) {
  variance_pass(plan, in, gbuffer, guide, radiance, std::nullopt, channel.name + ".variance",
                in.program(shaders::specular_variance), channel.settings)
      .host(kernels::specular_variance, in.constants);
}

}  // namespace heliograph::render
