#include "render/passes/denoise/atrous.hpp"

#include "render/passes/denoise/denoise_constants.hpp"

namespace heliograph::render {

gpu::ImageRef blur(gpu::FramePlan& plan, const FrameInputs& in, const AtrousInput& input,
                   const AtrousConfig& config, std::optional<Feedback> feedback) {
  const auto size = gpu::FrameSize::squares(config.pixels_per_texel);
  const auto image = [&](const BufferDescription& buffer) {
    return plan.image(buffer.name, VK_FORMAT_R32G32B32A32_SFLOAT, 0, size);
  };
  const bool separable = config.shape == protocol::BlurKernel::separable;
  const int last = config.iterations - 1;
  const gpu::ImageRef result = image(config.buffers.denoised);
  const bool halves_at_once = separable && plan.uses_host_kernels();
  // The second half of a separable iteration does not read the image that it writes: all of them
  // can write the same one.
  std::array<gpu::ImageRef, 2> between{result, result};
  if (halves_at_once) {
    if (last > 0) between[(last + 1) % 2] = image(config.buffers.even);
  } else {
    if (last > 0 && !separable) between[0] = between[1] = image(config.buffers.even);
    if (last > 1 && !separable) between[1] = image(config.buffers.odd);
  }
  const bool needs_half = separable && !halves_at_once;
  const gpu::ImageRef half = needs_half ? image(config.buffers.half) : gpu::ImageRef{};

  const auto pass = [&](const std::string& name, const gpu::ProgramSource& program,
                        gpu::ImageRef from, gpu::ImageRef to, auto shape) {
    plan.pass(name, program)
        .bind<kernels::AtrousBindings>({.guide = input.guide,
                                        .depth_slope = input.depth_slope,
                                        .signal = from,
                                        .filtered = to})
        .constants([constants = config.constants, shape] { return constants(shape()); })
        .dispatch(size)
        .host(config.kernel, in.constants);
  };
  const auto host_pass = [&](const std::string& name, gpu::ImageRef from, gpu::ImageRef to,
                             auto half_shape) {
    plan.host(name, {})
        .bind<kernels::AtrousBindings>({.guide = input.guide,
                                        .depth_slope = input.depth_slope,
                                        .signal = from,
                                        .filtered = to})
        .constants([constants = config.constants, half_shape] {
          return kernels::AtrousHalves{constants(half_shape(true)), constants(half_shape(false))};
        })
        .host(config.halves_kernel, in.constants);
  };
  gpu::ImageRef signal = input.signal;
  const auto side = static_cast<int>(config.pixels_per_texel);
  for (int level = 0; level <= last; ++level) {
    const gpu::ImageRef to = level == last ? result : between[level % 2];
    const std::string name = config.name + "." + std::to_string(level);
    if (separable) {
      // Which half comes first changes from iteration to iteration and frame to frame: otherwise
      // all streaks would have one direction.
      const auto half_shape = [&frame = in.constants, level, side](bool first_half) {
        const bool columns =
            ((frame.sample_index + static_cast<std::uint32_t>(level)) % 2 == 0) == first_half;
        return KernelShape{level, columns ? 2 : 0, columns ? 0 : 2, first_half, side};
      };
      if (halves_at_once) {
        host_pass(name, signal, to, half_shape);
      } else {
        pass(name + ".first", config.half_program, signal, half,
             [half_shape] { return half_shape(true); });
        pass(name + ".second", config.half_program, half, to,
             [half_shape] { return half_shape(false); });
      }
    } else {
      pass(name, config.program, signal, to, [level, side] {
        return KernelShape{level, 2, 2, false, side};
      });
    }
    signal = to;
    if (feedback && feedback->level == level) feedback->keep(signal);
  }
  return signal;
}

}  // namespace heliograph::render
