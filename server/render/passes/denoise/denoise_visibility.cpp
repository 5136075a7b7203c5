#include "render/passes/denoise/denoise_visibility.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/kernels/signals.hpp"
#include "render/kernels/visibility_half.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/denoise/temporal.hpp"
#include "render/passes/formats.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Apparent diameter of the softest light, degrees; local lights as seen from the scene's middle.
float widest_light(const FrameInputs& in) {
  const glm::vec3 middle = in.scene.scene->bounds.center();
  const float override_degrees = in.settings.shadows.angular_diameter_override;
  float widest = 0.0f;
  for (const shared::Light& light : in.moving.lights()) {
    float tangent = light.radius;
    if (light.type == shared::light_directional) {
      if (override_degrees >= 0.0f) tangent = std::tan(glm::radians(0.5f * override_degrees));
    } else {
      tangent /= std::max(glm::distance(light.position, middle), 1e-6f);
    }
    widest = std::max(widest, 2.0f * glm::degrees(std::atan(tangent)));
  }
  return widest;
}

AtrousConfig visibility_atrous_config(const FrameInputs& in, const AtrousBuffers& buffers) {
  const auto& settings = in.settings.shadow_blur;
  const auto constants = [in, &settings](const KernelShape& shape) {
    shared::AtrousConstants made = atrous_constants(settings, in.scene_motion, shape);
    const bool double_step = settings.adapt_start && widest_light(in) > settings.angle_threshold;
    made.start_threshold = double_step ? -1.0f : 2.0f;
    return made;
  };
  return {"visibility.atrous",
          buffers,
          in.program(shaders::visibility_atrous),
          {in.program(shaders::visibility_atrous_half_first),
           in.program(shaders::visibility_atrous_half),
           in.program(shaders::visibility_atrous_half_last),
           in.program(shaders::visibility_atrous_half_result)},
          kernels::visibility_atrous,
          kernels::visibility_atrous_halves,
          settings.iterations,
          settings.kernel,
          constants};
}

gpu::FrameSize half_size() {
  return gpu::FrameSize::squares(2);
}

AtrousInput halved(gpu::FramePlan& plan, const FrameInputs& in, const AtrousInput& input) {
  const auto& buffers = half_visibility_buffers;
  const AtrousInput made{
      plan.image(buffers.guide.name, formats::four_floats, 0, half_size()),
      plan.image(buffers.depth_slope.name, VK_FORMAT_R32G32_SFLOAT, 0, half_size()),
      plan.image(buffers.signal.name, formats::four_floats, 0, half_size()),
      declare_packed_guide(plan, buffers.guide, buffers.slope, half_size())};
  plan.pass("visibility.halve", in.program(shaders::visibility_halve))
      .bind<kernels::VisibilityHalveBindings>({.guide = input.guide,
                                               .depth_slope = input.depth_slope,
                                               .signal = input.signal,
                                               .half_guide = made.guide,
                                               .half_slope = made.depth_slope,
                                               .half_signal = made.signal,
                                               .packed_guide = made.packed.surface,
                                               .packed_slope = made.packed.slope})
      .constants([in] { return atrous_constants(in.settings.shadow_blur, in.scene_motion, {}); })
      .dispatch(half_size())
      .host(kernels::visibility_halve, in.constants);
  return made;
}

/// The first iteration is that of the upsampling, the others are made at half the size.
gpu::ImageRef blur_at_half_size(gpu::FramePlan& plan, const FrameInputs& in,
                                const AtrousInput& input) {
  AtrousInput half = halved(plan, in, input);
  AtrousConfig config = visibility_atrous_config(in, visibility_half_atrous_buffers);
  config.name = "visibility.half.atrous";
  config.pixels_per_texel = 2;
  --config.iterations;
  if (config.iterations > 0) half.signal = blur(plan, in, half, config, std::nullopt);
  const auto denoised = plan.image(visibility_atrous_buffers.denoised.name, formats::four_floats);
  plan.pass("visibility.upsample", in.program(shaders::visibility_upsample))
      .bind<kernels::VisibilityUpsampleBindings>({.guide = input.guide,
                                                  .depth_slope = input.depth_slope,
                                                  .signal = input.signal,
                                                  .half_guide = half.guide,
                                                  .half_signal = half.signal,
                                                  .denoised = denoised})
      .constants([in] { return atrous_constants(in.settings.shadow_blur, in.scene_motion, {}); })
      .dispatch(gpu::each_pixel())
      .host(kernels::visibility_upsample, in.constants);
  return denoised;
}

}  // namespace

gpu::ImageRef combine_visibility(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef shadows,
                                 gpu::ImageRef ambient, const std::function<bool()>& when_read) {
  const bool halves = formats::in_halves(plan);
  const auto noisy = plan.image(denoise_visibility_buffers.noisy.name,
                                halves ? formats::two_halves : formats::four_floats);
  const bool shadows_alone = !plan.uses_host_kernels() && in.settings.indirect.enabled;
  plan.pass("visibility.combine", in.program(shaders::visibility_combine))
      .bind<kernels::CombineBindings>({.shadows = shadows, .ambient = ambient, .visibility = noisy})
      .dispatch(gpu::each_pixel())
      .host(kernels::visibility_combine)
      .when(shadows_alone ? when_read : std::function<bool()>());
  return shadows_alone ? shadows : noisy;
}

gpu::ImageRef denoise_visibility(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Guide& guide,
                                 const SampleHistories& histories, gpu::ImageRef noisy) {
  const auto& blurring = in.settings.shadow_blur;
  const AccumulatedSignal accumulated = accumulate_visibility(plan, in, guide, histories, noisy);
  if (!blurring.enabled) return accumulated.signal;

  const auto feed_back = [&](gpu::ImageRef filtered) {
    feed_visibility_back(plan, in, accumulated, filtered);
  };
  estimate_visibility_variance(plan, in, gbuffer, guide, accumulated);
  const AtrousInput input{guide.surface, gbuffer.depth_slope, accumulated.signal, guide.packed};
  if (blurring.half_resolution && !feeds_back(blurring)) return blur_at_half_size(plan, in, input);
  return blur(
      plan, in, input, visibility_atrous_config(in, visibility_atrous_buffers),
      feeds_back(blurring) ? std::optional(Feedback{blurring.feedback, feed_back}) : std::nullopt);
}

SignalBlur visibility_to_blur(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                              const Guide& guide, const SampleHistories& histories,
                              gpu::ImageRef noisy) {
  const AccumulatedSignal accumulated = accumulate_visibility(plan, in, guide, histories, noisy);
  estimate_visibility_variance(plan, in, gbuffer, guide, accumulated);
  return {{guide.surface, gbuffer.depth_slope, accumulated.signal, guide.packed},
          visibility_atrous_config(in, visibility_atrous_buffers)};
}

}  // namespace heliograph::render
