#include "render/passes/denoise/atrous.hpp"

#include <utility>

#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/formats.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

using formats::four_floats;
using formats::four_halves;

/// One blur under declaration.
class Blur {
 public:
  Blur(gpu::FramePlan& plan, const FrameInputs& in, const AtrousInput& input,
       const AtrousConfig& config, const std::optional<Feedback>& feedback)
      : plan_(plan),
        in_(in),
        input_(input),
        config_(config),
        feedback_(feedback),
        size_(gpu::FrameSize::squares(config.pixels_per_texel)),
        side_(static_cast<int>(config.pixels_per_texel)),
        last_(config.iterations - 1),
        result_(image(config.buffers.denoised, four_floats)) {}

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
          .constants([constants = config_.constants, shape = half_shape(level)] {
            return kernels::AtrousHalves{constants(shape(true)), constants(shape(false))};
          })
          .host(config_.halves_kernel, in_.constants);
      signal = to;
      feed_back(level, signal);
    }
    return signal;
  }

  /// A pass of the device for each half. What is fed back holds 32 bits, as the result does.
  gpu::ImageRef halves() {
    const AtrousHalfPrograms& programs = config_.half_programs;
    const gpu::ImageRef half = image(config_.buffers.half, four_halves);
    // The second half does not read the image that it writes: one serves all iterations.
    std::optional<gpu::ImageRef> between;
    gpu::ImageRef signal = input_.signal;
    bool in_floats = true;
    for (int level = 0; level <= last_; ++level) {
      const bool to_floats = level == last_ || feeds_back(level);
      if (!to_floats && !between) between = image(config_.buffers.even, four_halves);
      const gpu::ImageRef to = to_floats ? result_ : *between;
      half_pass(level, true, in_floats ? programs.first : programs.between, signal, half);
      half_pass(level, false, to_floats ? programs.last : programs.between, half, to);
      signal = to;
      in_floats = to_floats;
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
  void feed_back(int level, gpu::ImageRef filtered) const {
    if (feeds_back(level)) feedback_->keep(filtered);
  }

  /// Of the first or the second half. Which of them is the one across changes from iteration to
  /// iteration and frame to frame: otherwise all streaks would have one direction.
  std::function<KernelShape(bool)> half_shape(int level) const {
    return [&frame = in_.constants, level, side = side_](bool first_half) {
      const bool columns =
          ((frame.sample_index + static_cast<std::uint32_t>(level)) % 2 == 0) == first_half;
      return KernelShape{level, columns ? 2 : 0, columns ? 0 : 2, first_half, side};
    };
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
    pass(name(level) + (first ? ".first" : ".second"), program,
         {input_.packed.surface.value(), input_.packed.slope.value(), from, to},
         [shape = half_shape(level), first] { return shape(first); });
  }

  gpu::FramePlan& plan_;
  const FrameInputs& in_;
  const AtrousInput& input_;
  const AtrousConfig& config_;
  const std::optional<Feedback>& feedback_;
  gpu::FrameSize size_;
  int side_;
  int last_;
  gpu::ImageRef result_;
};

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
       in.program(shaders::specular_atrous_half_last)},
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
  return plan.uses_host_kernels() ? made.halves_at_once() : made.halves();
}

}  // namespace heliograph::render
