#include "render/passes/denoise/denoise_visibility.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/kernels/signals.hpp"
#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/denoise_constants.hpp"
#include "render/passes/denoise/temporal.hpp"
#include "render/resources/moving_scene.hpp"
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

AtrousConfig visibility_atrous_config(const FrameInputs& in) {
  const auto& settings = in.settings.shadow_blur;
  const auto constants = [in, &settings](const KernelShape& shape) {
    shared::AtrousConstants made = atrous_constants(settings, in.scene_motion, shape);
    const bool double_step = settings.adapt_start && widest_light(in) > settings.angle_threshold;
    made.start_threshold = double_step ? -1.0f : 2.0f;
    return made;
  };
  return {"visibility.atrous",
          visibility_atrous_buffers,
          in.program(shaders::visibility_atrous),
          kernels::visibility_atrous,
          kernels::visibility_atrous_halves,
          settings.iterations,
          settings.kernel,
          constants};
}

}  // namespace

gpu::ImageRef combine_visibility(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef shadows,
                                 gpu::ImageRef ambient) {
  const auto noisy =
      plan.image(denoise_visibility_buffers.noisy.name, VK_FORMAT_R32G32B32A32_SFLOAT);
  plan.pass("visibility.combine", in.program(shaders::visibility_combine))
      .bind<kernels::CombineBindings>({.shadows = shadows, .ambient = ambient, .visibility = noisy})
      .dispatch(gpu::each_pixel())
      .host(kernels::visibility_combine);
  return noisy;
}

gpu::ImageRef denoise_visibility(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Guide& guide,
                                 const SampleHistories& histories, gpu::ImageRef noisy) {
  const auto& blurring = in.settings.shadow_blur;
  const bool feedback =
      blurring.enabled && blurring.feedback >= 0 && blurring.feedback < blurring.iterations;

  const AccumulatedSignal accumulated = accumulate_visibility(plan, in, guide, histories, noisy);
  if (!blurring.enabled) return accumulated.signal;

  const auto feed_back = [&](gpu::ImageRef filtered) {
    feed_visibility_back(plan, in, accumulated, filtered);
  };
  estimate_visibility_variance(plan, in, gbuffer, guide, accumulated);
  return blur(plan, in, gbuffer, guide, visibility_atrous_config(in), accumulated.signal,
              feedback ? std::optional(Feedback{blurring.feedback, feed_back}) : std::nullopt);
}

}  // namespace heliograph::render
