#include "render/passes/denoise/denoise_indirect.hpp"

#include "render/kernels/indirect/indirect_half.hpp"
#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/formats.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Its lobe is as wide as that of the roughest reflection.
AtrousConfig indirect_atrous_config(const FrameInputs& in) {
  const auto& settings = in.settings.indirect_blur;
  const auto constants = [in, &settings](const KernelShape& shape) {
    shared::AtrousConstants made = atrous_constants(settings, in.scene_motion, shape);
    made.start_threshold = settings.adapt_start ? -1.0f : 2.0f;
    return made;
  };
  return radiance_atrous_config(in, "indirect.atrous", indirect_atrous_buffers, settings.iterations,
                                settings.kernel, constants);
}

/// At the size of `noisy` and of what guides it.
gpu::ImageRef denoise(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                      const Guide& guide, const SampleHistories& histories, gpu::ImageRef noisy) {
  const auto& blurring = in.settings.indirect_blur;
  const RadianceChannel channel = indirect_channel(plan, in, histories);
  const AccumulatedSignal accumulated =
      accumulate_radiance(plan, in, gbuffer, guide, channel, noisy);
  if (!blurring.enabled) return accumulated.signal;
  const auto feed_back = [&](gpu::ImageRef filtered) {
    feed_radiance_back(plan, in, channel, accumulated, filtered);
  };
  estimate_radiance_variance(plan, in, gbuffer, guide, channel, accumulated);
  return blur(
      plan, in, {guide.surface, gbuffer.depth_slope, accumulated.signal, guide.packed},
      indirect_atrous_config(in),
      feeds_back(blurring) ? std::optional(Feedback{blurring.feedback, feed_back}) : std::nullopt);
}

struct Halved {
  GBuffer gbuffer;  // as far as denoisers read it
  gpu::ImageRef radiance;
};

Halved halve(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
             gpu::ImageRef noisy) {
  const auto& buffers = indirect_half_buffers;
  const auto size = gpu::FrameSize::squares(2);
  const auto history = [&](const BufferDescription& buffer, VkFormat format) {
    return plan.history(buffer.name, format, 0, size);
  };
  const gpu::History normals = history(buffers.normals, formats::four_floats);
  const gpu::History motion = history(buffers.motion, formats::four_floats);
  const gpu::History instance = history(buffers.instance, VK_FORMAT_R32_UINT);
  const auto surface = plan.image(buffers.surface.name, VK_FORMAT_R8G8B8A8_UNORM, 0, size);
  const auto slope = plan.image(buffers.depth_slope.name, VK_FORMAT_R32G32_SFLOAT, 0, size);
  const auto radiance = plan.image(buffers.radiance.name, formats::four_floats, 0, size);
  plan.pass("indirect.halve", in.program(shaders::indirect_halve))
      .bind<kernels::IndirectHalveBindings>({.normals = gbuffer.normals,
                                             .motion = gbuffer.motion,
                                             .depth_slope = gbuffer.depth_slope,
                                             .instance = gbuffer.instance,
                                             .radiance = noisy,
                                             .half_normals = normals.current,
                                             .half_motion = motion.current,
                                             .half_slope = slope,
                                             .half_instance = instance.current,
                                             .half_surface = surface,
                                             .half_radiance = radiance})
      .dispatch(size)
      .host(kernels::indirect_halve, in.constants);
  GBuffer half;
  half.normals = normals.current;
  half.motion = motion.current;
  half.instance = instance.current;
  half.surface = half.previous_surface = surface;
  half.depth_slope = slope;
  half.previous_normals = normals.previous;
  half.previous_motion = motion.previous;
  half.previous_instance = instance.previous;
  return {half, radiance};
}

gpu::ImageRef upsample(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                       const Guide& guide, const Guide& half_guide, gpu::ImageRef half) {
  const auto denoised = plan.image(indirect_half_buffers.upsampled.name, formats::four_floats);
  plan.pass("indirect.upsample", in.program(shaders::indirect_upsample))
      .bind<kernels::IndirectUpsampleBindings>({.guide = guide.surface,
                                                .depth_slope = gbuffer.depth_slope,
                                                .half_guide = half_guide.surface,
                                                .half_signal = half,
                                                .denoised = denoised})
      .constants([in] { return atrous_constants(in.settings.indirect_blur, in.scene_motion, {}); })
      .dispatch(gpu::each_pixel())
      .host(kernels::indirect_upsample, in.constants);
  return denoised;
}

}  // namespace

gpu::ImageRef denoise_indirect(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, const SampleHistories& histories,
                               gpu::ImageRef noisy) {
  if (!in.settings.indirect.half_resolution)
    return denoise(plan, in, gbuffer, guide, histories, noisy);
  const Halved half = halve(plan, in, gbuffer, noisy);
  Guide half_guide;
  gpu::ImageRef denoised;
  plan.reduced(2, [&] {
    const FrameInputs half_in = in.at_half_size();
    half_guide =
        reproject(plan, half_in, half.gbuffer, "indirect.reproject", indirect_reproject_buffers);
    denoised = denoise(plan, half_in, half.gbuffer, half_guide, histories, half.radiance);
  });
  return upsample(plan, in, gbuffer, guide, half_guide, denoised);
}

}  // namespace heliograph::render
