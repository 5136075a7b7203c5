#include "render/passes/denoise/atrous.hpp"

#include <utility>

#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/formats.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::four_floats;
using formats::four_halves;

/// What the passes of a blur by halves write.
struct HalfImages {
  gpu::ImageRef half;  // after the first half of an iteration
  /// After the second, which does not read the image that it writes: one serves all iterations.
  std::optional<gpu::ImageRef> between;
  gpu::ImageRef result;
};

/// Of the first or the second half. Which of them is the one across changes from iteration to
/// iteration and frame to frame: otherwise all streaks would have one direction.
auto half_shape(const FrameInputs& in, int level, int side) {
  return [&frame = in.constants, level, side](bool first_half) {
    const bool columns =
        ((frame.sample_index + static_cast<std::uint32_t>(level)) % 2 == 0) == first_half;
    return KernelShape{level, columns ? 2 : 0, columns ? 0 : 2, first_half, side};
  };
}

std::string half_name(const std::string& blur, int level, bool first) {
  return blur + "." + std::to_string(level) + (first ? ".first" : ".second");
}

/// One blur under declaration.
class Blur {
 public:
  Blur(gpu::FramePlan& plan, const FrameInputs& in, const AtrousInput& input,
       const AtrousConfig& config, const std::optional<Feedback>& feedback,
       VkFormat result_format = four_floats)
      : plan_(plan),
        in_(in),
        input_(input),
        config_(config),
        feedback_(feedback),
        size_(gpu::FrameSize::squares(config.pixels_per_texel)),
        side_(static_cast<int>(config.pixels_per_texel)),
        last_(config.iterations - 1),
        result_in_floats_(result_format == four_floats),
        result_(image(config.buffers.denoised, result_format)) {}

  /// Both halves of the kernel at once.
  gpu::ImageRef whole() {
    std::array<gpu::ImageRef, 2> between{result_, result_};
    if (last_ > 0) between[0] = between[1] = image(config_.buffers.even, four_floats);
    if (last_ > 1) between[1] = image(config_.buffers.odd, four_floats);
    gpu::ImageRef signal = input_.signal;
    for (int level = 0; level <= last_; ++level) {
      const gpu::ImageRef to = level == last_ ? result_ : between[level % 2];
      pass(name(level), config_.program, {input_.guide, input_.depth_slope, signal, to},
           [level, side = side_] {
             return KernelShape{level, 2, 2, false, side};
           })
          .host(config_.kernel, in_.constants);
      signal = to;
      feed_back(level, signal);
    }
    return signal;
  }

  /// Both halves in one pass of the host.
  gpu::ImageRef halves_at_once() {
    std::array<gpu::ImageRef, 2> between{result_, result_};
    if (last_ > 0) between[(last_ + 1) % 2] = image(config_.buffers.even, four_floats);
    gpu::ImageRef signal = input_.signal;
    for (int level = 0; level <= last_; ++level) {
      const gpu::ImageRef to = level == last_ ? result_ : between[level % 2];
      plan_.host(name(level), {})
          .bind<kernels::AtrousBindings>({.guide = input_.guide,
                                          .depth_slope = input_.depth_slope,
                                          .signal = signal,
                                          .filtered = to})
          .constants([constants = config_.constants, shape = half_shape(in_, level, side_)] {
            return kernels::AtrousHalves{constants(shape(true)), constants(shape(false))};
          })
          .host(config_.halves_kernel, in_.constants);
      signal = to;
      feed_back(level, signal);
    }
    return signal;
  }

  HalfImages half_images() {
    HalfImages made{image(config_.buffers.half, four_halves), std::nullopt, result_};
    for (int level = 0; level <= last_ && !made.between; ++level) {
      if (!is_result(level)) made.between = image(config_.buffers.even, four_halves);
    }
    return made;
  }

  /// A pass of the device for each half.
  gpu::ImageRef halves(const HalfImages& images) {
    const AtrousHalfPrograms& programs = config_.half_programs;
    gpu::ImageRef signal = input_.signal;
    bool in_floats = true;
    for (int level = 0; level <= last_; ++level) {
      const gpu::ImageRef to = is_result(level) ? result_ : *images.between;
      half_pass(level, true, in_floats ? programs.first : programs.between, signal, images.half);
      half_pass(level, false, second_program(level), images.half, to);
      signal = to;
      in_floats = is_result(level);
      feed_back(level, signal);
    }
    return signal;
  }

 private:
  gpu::ImageRef image(const BufferDescription& buffer, VkFormat format) {
    return plan_.image(buffer.name, format, 0, size_);
  }
  std::string name(int level) const { return config_.name + "." + std::to_string(level); }
  bool feeds_back(int level) const { return feedback_ && feedback_->level == level; }
  /// What is fed back is written as the result is.
  bool is_result(int level) const { return level == last_ || feeds_back(level); }
  const gpu::ProgramSource& second_program(int level) const {
    const AtrousHalfPrograms& programs = config_.half_programs;
    if (!is_result(level)) return programs.between;
    return result_in_floats_ ? programs.last : programs.last_in_halves;
  }
  void feed_back(int level, gpu::ImageRef filtered) const {
    if (feeds_back(level)) feedback_->keep(filtered);
  }

  gpu::PassBuilder pass(const std::string& name, const gpu::ProgramSource& program,
                        const kernels::AtrousBindings<gpu::Declared>& bindings, auto shape) {
    gpu::PassBuilder made = plan_.pass(name, program);
    made.bind<kernels::AtrousBindings>(bindings)
        .constants([constants = config_.constants, shape] { return constants(shape()); })
        .dispatch(size_);
    return made;
  }

  void half_pass(int level, bool first, const gpu::ProgramSource& program, gpu::ImageRef from,
                 gpu::ImageRef to) {
    pass(half_name(config_.name, level, first), program,
         {input_.packed.surface.value(), input_.packed.slope.value(), from, to},
         [shape = half_shape(in_, level, side_), first] { return shape(first); });
  }

  gpu::FramePlan& plan_;
  const FrameInputs& in_;
  const AtrousInput& input_;
  const AtrousConfig& config_;
  const std::optional<Feedback>& feedback_;
  gpu::FrameSize size_;
  int side_;
  int last_;
  bool result_in_floats_;
  gpu::ImageRef result_;
};

/// What a pass for two signals reads or writes of each.
struct PairImages {
  gpu::ImageRef visibility, specular;
};

/// The halves of two blurs of as many iterations at full size, each a pass for both signals.
class PairedHalves {
 public:
  PairedHalves(gpu::FramePlan& plan, const FrameInputs& in, const SignalBlur& visibility,
               const SignalBlur& specular)
      : plan_(plan), in_(in), visibility_(visibility), specular_(specular) {}

  void declare(const HalfImages& visibility, const HalfImages& specular) {
    const gpu::ProgramSource first = in_.program(shaders::visibility_specular_atrous_first);
    const gpu::ProgramSource between = in_.program(shaders::visibility_specular_atrous);
    const gpu::ProgramSource to_result = in_.program(shaders::visibility_specular_atrous_last);
    const PairImages half{visibility.half, specular.half};
    PairImages signal{visibility_.input.signal, specular_.input.signal};
    const int last = visibility_.config.iterations - 1;
    for (int level = 0; level <= last; ++level) {
      const PairImages to = level == last
                                ? PairImages{visibility.result, specular.result}
                                : PairImages{visibility.between.value(), specular.between.value()};
      half_pass(level, true, level == 0 ? first : between, signal, half);
      half_pass(level, false, level == last ? to_result : between, half, to);
      signal = to;
    }
  }

 private:
  /// As the shader's push constants.
  struct Constants {
    shared::AtrousConstants visibility, specular;
  };

  void half_pass(int level, bool first, const gpu::ProgramSource& program, const PairImages& from,
                 const PairImages& to) {
    const PackedGuide& guide = visibility_.input.packed;
    plan_.pass(half_name("visibility_specular.atrous", level, first), program)
        .read(guide.surface.value())
        .read(guide.slope.value())
        .read(from.visibility)
        .read(from.specular)
        .write(to.visibility)
        .write(to.specular)
        .constants([visibility = visibility_.config.constants,
                    specular = specular_.config.constants, shape = half_shape(in_, level, 1),
                    first] {
          return Constants{visibility(shape(first)), specular(shape(first))};
        })
        .dispatch(gpu::each_pixel());
  }

  gpu::FramePlan& plan_;
  const FrameInputs& in_;
  const SignalBlur& visibility_;
  const SignalBlur& specular_;
};

/// Whether the taps of both are the same texels, and their surfaces weigh the same.
bool have_the_same_taps(const shared::AtrousConstants& a, const shared::AtrousConstants& b) {
  constexpr std::uint32_t same = shared::atrous_variance_prefilter | shared::atrous_jitter;
  return a.normal_power == b.normal_power && a.depth_sigma == b.depth_sigma &&
         a.start_threshold == b.start_threshold && ((a.flags ^ b.flags) & same) == 0;
}

}  // namespace

AtrousConfig radiance_atrous_config(
    const FrameInputs& in, std::string name, const AtrousBuffers& buffers, int iterations,
    protocol::BlurKernel shape,
    std::function<shared::AtrousConstants(const KernelShape&)> constants) {
  return {
      std::move(name),
      buffers,
      in.program(shaders::specular_atrous),
      {in.program(shaders::specular_atrous_half_first), in.program(shaders::specular_atrous_half),
       in.program(shaders::specular_atrous_half_last),
       in.program(shaders::specular_atrous_half_result)},
      kernels::specular_atrous,
      kernels::specular_atrous_halves,
      iterations,
      shape,
      std::move(constants)};
}

gpu::ImageRef blur(gpu::FramePlan& plan, const FrameInputs& in, const AtrousInput& input,
                   const AtrousConfig& config, std::optional<Feedback> feedback) {
  Blur made(plan, in, input, config, feedback);
  if (config.shape == protocol::BlurKernel::full) return made.whole();
  return plan.uses_host_kernels() ? made.halves_at_once() : made.halves(made.half_images());
}

bool can_blur_together(const gpu::FramePlan& plan, const protocol::BlurSettings& a,
                       const protocol::BlurSettings& b) {
  const auto by_plain_halves = [](const protocol::BlurSettings& settings) {
    return settings.enabled && settings.kernel == protocol::BlurKernel::separable &&
           !feeds_back(settings);
  };
  return !plan.uses_host_kernels() && !plan.device().is_cpu() && by_plain_halves(a) &&
         by_plain_halves(b) && a.iterations == b.iterations;
}

BlurredPair blur_together(gpu::FramePlan& plan, const FrameInputs& in, const SignalBlur& visibility,
                          const SignalBlur& specular,
                          const std::function<bool()>& traces_visibility) {
  const std::optional<Feedback> none;
  Blur visibility_alone(plan, in, visibility.input, visibility.config, none, four_halves);
  Blur specular_alone(plan, in, specular.input, specular.config, none, four_halves);
  const HalfImages visibility_images = visibility_alone.half_images();
  const HalfImages specular_images = specular_alone.half_images();
  const auto together = [traces_visibility, a = visibility.config.constants,
                         b = specular.config.constants] {
    return traces_visibility() && have_the_same_taps(a({}), b({}));
  };
  const auto apart = [&] {
    plan.only_when(traces_visibility, [&] { visibility_alone.halves(visibility_images); });
    specular_alone.halves(specular_images);
  };
  PairedHalves pair(plan, in, visibility, specular);
  plan.only_when(
      together, [&] { pair.declare(visibility_images, specular_images); }, apart);
  return {visibility_images.result, specular_images.result};
}

}  // namespace heliograph::render
