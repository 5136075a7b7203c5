#include "render/passes/denoise/atrous.hpp"

#include <array>

#include "render/passes/denoise/denoise_constants.hpp"

namespace heliograph::render {
namespace {

struct IterationImages {
  gpu::ImageRef guide;
  gpu::ImageRef depth_slope;
  gpu::ImageRef signal;
  gpu::ImageRef filtered;
};

/// The shader, or its twin where the device's memory is the host's.
gpu::PassBuilder iteration(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                           const Blur& blur, const IterationImages& images,
                           std::function<shared::AtrousConstants()> constants) {
  if (!on_host(plan, in)) {
    return plan.pass(name, blur.program).constants(constants).dispatch(plan.extent());
  }
  return plan.host(name, [&plan, &frame = in.constants, kind = blur.kind, images, constants] {
    const auto view = [&plan](gpu::ImageRef image) { return plan.get(image).host(); };
    kernels::atrous(
        kind, constants(), frame,
        {view(images.guide), view(images.depth_slope), view(images.signal), view(images.filtered)});
  });
}

}  // namespace

gpu::ImageRef blur(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                   const Guide& guide, const Blur& blur, gpu::ImageRef signal,
                   std::optional<Feedback> feedback) {
  const auto image = [&](const char* suffix) {
    return plan.image(blur.name + suffix, VK_FORMAT_R32G32B32A32_SFLOAT);
  };
  const bool separable = blur.kernel == protocol::BlurKernel::separable;
  const int last = blur.iterations - 1;
  const gpu::ImageRef result = image(".denoised");
  std::array<gpu::ImageRef, 2> between{};
  if (last > 0) between[0] = image(".blur.even");
  if (last > 1) between[1] = image(".blur.odd");
  const gpu::ImageRef half = separable ? image(".blur.half") : gpu::ImageRef{};

  const auto pass = [&](const std::string& name, gpu::ImageRef from, gpu::ImageRef to, auto shape) {
    const auto constants = [constants = blur.constants, shape] { return constants(shape()); };
    iteration(plan, in, name, blur, {guide.surface, gbuffer.depth_slope, from, to}, constants)
        .read(guide.surface)
        .read(gbuffer.depth_slope)
        .read(from)
        .write(to)
        .describe("The signal on its way through the blur: values and the variance left.");
  };
  for (int level = 0; level <= last; ++level) {
    gpu::ImageRef to = level == last ? result : between[level % 2];
    if (feedback && feedback->level == level) to = feedback->image;
    const std::string name = blur.name + ".atrous." + std::to_string(level);
    if (separable) {
      // Which half comes first changes from iteration to iteration and frame to frame: streaks
      // would all run one way.
      const auto half_shape = [&frame = in.constants.sample_index, level](bool first_half) {
        const bool across = ((frame + static_cast<std::uint32_t>(level)) % 2 == 0) == first_half;
        return KernelShape{level, across ? 2 : 0, across ? 0 : 2, first_half};
      };
      pass(name + ".first", signal, half, [half_shape] { return half_shape(true); });
      pass(name + ".second", half, to, [half_shape] { return half_shape(false); });
    } else {
      pass(name, signal, to, [level] { return KernelShape{level, 2, 2, false}; });
    }
    signal = to;
  }
  return signal;
}

}  // namespace heliograph::render
