#include "render/passes/denoise/temporal.hpp"

#include "render/kernels/spatial_variance.hpp"
#include "render/kernels/temporal.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

constexpr VkFormat four_floats = VK_FORMAT_R32G32B32A32_SFLOAT;

/// The spread of brightness in every tile of 8x8 pixels of `raw`, for the rectification that needs
/// it; otherwise any image, which nobody reads.
gpu::ImageRef measure_percentiles(gpu::FramePlan& plan, const Guide& guide, gpu::ImageRef raw,
                                  const std::string& signal, const gpu::ComputeProgram& program,
                                  protocol::Rectification rectification) {
  if (rectification != protocol::Rectification::percentile) return guide.reprojection;
  const VkExtent2D tiles{(plan.extent().width + 7) / 8, (plan.extent().height + 7) / 8};
  const auto percentiles = plan.image(signal + ".percentiles", four_floats, 0, tiles);
  plan.pass(signal + ".percentiles", program)
      .read(guide.surface)
      .read(raw)
      .write(percentiles)
      .dispatch(plan.extent())
      .describe("Tenth and ninetieth percentile of the brightness in every tile of 8x8 pixels.");
  return percentiles;
}

/// The shader, or its twin where the device's memory is the host's and the twin knows the
/// rectification. `run` takes what is the same for all kernels: constants and how to view an image.
template <class Constants, class Run>
gpu::PassBuilder declare_pass(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                              const gpu::ComputeProgram& program,
                              protocol::Rectification rectification, const Constants& constants,
                              const Run& run) {
  const bool known = kernels::can_accumulate(static_cast<std::uint32_t>(rectification));
  if (!on_host(plan, in) || !known) {
    return plan.pass(name, program).constants(constants).dispatch(plan.extent());
  }
  return plan.host(name, [&plan, constants, run] {
    run(constants(), [&plan](gpu::ImageRef image) { return plan.get(image).host(); });
  });
}

/// Whether a pass of its own rectifies, after accumulation.
bool rectifies_after(protocol::Rectification mode) {
  return mode == protocol::Rectification::fast_history || mode == protocol::Rectification::gradient;
}

/// Holds the long history against the short one, or shortens it where the signal changes.
gpu::PassBuilder rectify(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                         const gpu::ComputeProgram& program,
                         void (*kernel)(const kernels::RectifyJob&), const Guide& guide,
                         gpu::ImageRef fast, gpu::ImageRef signal, gpu::ImageRef history,
                         const auto& constants) {
  return declare_pass(plan, in, name, program, protocol::Rectification::fast_history, constants,
                      [=, extent = plan.extent()](const auto& now, const auto& view) {
                        kernel({.constants = now,
                                .width = static_cast<int>(extent.width),
                                .height = static_cast<int>(extent.height),
                                .guide = view(guide.surface),
                                .fast = view(fast),
                                .signal = view(signal),
                                .history = view(history)});
                      })
      .read(guide.surface)
      .read(fast)
      .read_write(signal)
      .read_write(history);
}

}  // namespace

Integrated accumulate_visibility(gpu::FramePlan& plan, const FrameInputs& in, const Guide& guide,
                                 gpu::ImageRef raw, bool feedback) {
  const gpu::History memory = plan.history("visibility.memory", four_floats);
  const gpu::History moments = plan.history("visibility.moments", four_floats);
  const gpu::History history = plan.history("visibility.history", four_floats);
  const gpu::History fast = plan.history("visibility.fast", VK_FORMAT_R32G32_SFLOAT);
  const auto& settings = in.settings.shadow_temporal;
  const auto constants = [in, &settings] { return temporal_constants(in, settings); };
  const gpu::ImageRef signal =
      feedback ? plan.image("visibility.temporal", four_floats) : memory.current;

  const gpu::ImageRef percentiles = measure_percentiles(
      plan, guide, raw, "visibility", in.programs.compute(shaders::visibility_percentiles),
      settings.rectification);
  const auto run = [=, extent = plan.extent(), &frame = in.constants](const auto& now,
                                                                      const auto& view) {
    kernels::accumulate_visibility({.frame = frame,
                                    .constants = now,
                                    .width = static_cast<int>(extent.width),
                                    .height = static_cast<int>(extent.height),
                                    .raw = view(raw),
                                    .guide = view(guide.surface),
                                    .reprojection = view(guide.reprojection),
                                    .previous_signal = view(memory.previous),
                                    .previous_moments = view(moments.previous),
                                    .previous_history = view(history.previous),
                                    .previous_fast = view(fast.previous),
                                    .signal = view(signal),
                                    .moments = view(moments.current),
                                    .history = view(history.current),
                                    .fast = view(fast.current)});
  };
  declare_pass(plan, in, "visibility.temporal", in.programs.compute(shaders::visibility_temporal),
               settings.rectification, constants, run)
      .read(raw)
      .read(guide.surface)
      .read(guide.reprojection)
      .read(memory.previous)
      .read(moments.previous)
      .read(history.previous)
      .read(fast.previous)
      .read(percentiles)
      .write(signal)
      .write(moments.current)
      .write(history.current)
      .write(fast.current)
      .describe(
          "Shadow (red) and ambient (green) visibility gathered over frames: mean and "
          "variance, moments, frames remembered and how far the mean was moved, the last few "
          "frames alone.");
  if (rectifies_after(settings.rectification)) {
    rectify(plan, in, "visibility.rectify", in.programs.compute(shaders::visibility_rectify),
            kernels::rectify_visibility, guide, fast.current, signal, history.current, constants)
        // Visibility does not depend on the view: it changes only where something moves.
        .when([&settings, &motion = in.scene_motion] {
          return settings.rectification != protocol::Rectification::gradient || motion.things;
        });
  }
  return {signal, moments.current, history.current, memory.current};
}

Integrated accumulate_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, gpu::ImageRef raw, bool feedback) {
  const gpu::History memory = plan.history("specular.memory", four_floats);
  const gpu::History history = plan.history("specular.history", four_floats);
  const gpu::History fast = plan.history("specular.fast", four_floats);
  const auto& settings = in.settings.specular_temporal;
  const auto constants = [in, &settings] {
    shared::TemporalConstants made = temporal_constants(in, settings);
    if (settings.virtual_point) made.flags |= shared::temporal_virtual_motion;
    if (settings.bent_mirrors) made.flags |= shared::temporal_curved_reflectors;
    return made;
  };
  const gpu::ImageRef signal =
      feedback ? plan.image("specular.temporal", four_floats) : memory.current;

  const gpu::ImageRef percentiles = measure_percentiles(
      plan, guide, raw, "specular", in.programs.compute(shaders::specular_percentiles),
      settings.rectification);
  const auto run = [=, extent = plan.extent(), &frame = in.constants](const auto& now,
                                                                      const auto& view) {
    kernels::accumulate_specular({.frame = frame,
                                  .constants = now,
                                  .width = static_cast<int>(extent.width),
                                  .height = static_cast<int>(extent.height),
                                  .raw = view(raw),
                                  .guide = view(guide.surface),
                                  .instance = view(gbuffer.instance),
                                  .reprojection = view(guide.reprojection),
                                  .previous_normals = view(gbuffer.previous_normals),
                                  .previous_surface = view(gbuffer.previous_surface),
                                  .previous_motion = view(gbuffer.previous_motion),
                                  .previous_instance = view(gbuffer.previous_instance),
                                  .previous_signal = view(memory.previous),
                                  .previous_history = view(history.previous),
                                  .previous_fast = view(fast.previous),
                                  .signal = view(signal),
                                  .history = view(history.current),
                                  .fast = view(fast.current)});
  };
  declare_pass(plan, in, "specular.temporal", in.programs.compute(shaders::specular_temporal),
               settings.rectification, constants, run)
      .read(raw)
      .read(guide.surface)
      .read(gbuffer.instance)
      .read(guide.reprojection)
      .read(gbuffer.previous_normals)
      .read(gbuffer.previous_surface)
      .read(gbuffer.previous_motion)
      .read(gbuffer.previous_instance)
      .read(memory.previous)
      .read(history.previous)
      .read(fast.previous)
      .read(percentiles)
      .write(signal)
      .write(history.current)
      .write(fast.current)
      .describe(
          "Reflections gathered over frames: mean and variance; frames remembered, how far "
          "the mean was moved, and moments; the last few frames alone.");
  if (rectifies_after(settings.rectification)) {
    rectify(plan, in, "specular.rectify", in.programs.compute(shaders::specular_rectify),
            kernels::rectify_specular, guide, fast.current, signal, history.current, constants)
        .when([&settings, &samples = in.samples] {
          return settings.rectification != protocol::Rectification::gradient || samples == 0;
        });
  }
  return {signal, history.current, history.current, memory.current};
}

namespace {

void estimate_variance(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                       const Guide& guide, const Integrated& integrated, const char* name,
                       const gpu::ComputeProgram& program, kernels::Signal kind,
                       const auto& settings) {
  const auto constants = [in, &settings] { return temporal_constants(in, settings); };
  const auto run = [=, extent = plan.extent(), &frame = in.constants](const auto& now,
                                                                      const auto& view) {
    kernels::spatial_variance({.kind = kind,
                               .frame = frame,
                               .constants = now,
                               .width = static_cast<int>(extent.width),
                               .height = static_cast<int>(extent.height),
                               .guide = view(guide.surface),
                               .depth_slope = view(gbuffer.depth_slope),
                               .moments = view(integrated.moments),
                               .history = view(integrated.history),
                               .signal = view(integrated.signal)});
  };
  declare_pass(plan, in, name, program, protocol::Rectification::off, constants, run)
      .read(guide.surface)
      .read(gbuffer.depth_slope)
      .read(integrated.moments)
      .read(integrated.history)
      .read_write(integrated.signal)
      .when([&settings] { return settings.spatial_variance_frames > 0; });
}

}  // namespace

void estimate_visibility_variance(gpu::FramePlan& plan, const FrameInputs& in,
                                  const GBuffer& gbuffer, const Guide& guide,
                                  const Integrated& visibility) {
  estimate_variance(plan, in, gbuffer, guide, visibility, "visibility.variance",
                    in.programs.compute(shaders::visibility_variance), kernels::Signal::visibility,
                    in.settings.shadow_temporal);
}

void estimate_specular_variance(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                                const Guide& guide, const Integrated& specular) {
  estimate_variance(plan, in, gbuffer, guide, specular, "specular.variance",
                    in.programs.compute(shaders::specular_variance), kernels::Signal::specular,
                    in.settings.specular_temporal);
}

}  // namespace heliograph::render
