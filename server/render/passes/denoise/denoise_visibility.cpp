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

Blur visibility_blur(const FrameInputs& in) {
  const auto& settings = in.settings.shadow_blur;
  const auto constants = [in, &settings](const KernelShape& shape) {
    shared::AtrousConstants made = atrous_constants(settings, shape);
    const bool twice = settings.adapt_start && widest_light(in) > settings.angle_threshold;
    made.start_threshold = twice ? -1.0f : 2.0f;
    return made;
  };
  return {"visibility",        in.programs.compute(shaders::visibility_atrous),
          settings.iterations, settings.kernel,
          constants,           kernels::Signal::visibility};
}

}  // namespace

gpu::ImageRef combine_visibility(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef shadows,
                                 gpu::ImageRef ambient) {
  const auto raw = plan.image("visibility.raw", VK_FORMAT_R32G32B32A32_SFLOAT);
  const auto declare = [&] {
    if (!on_host(plan, in)) {
      return plan.pass("visibility.combine", in.programs.compute(shaders::visibility_combine))
          .dispatch(plan.extent());
    }
    return plan.host("visibility.combine", [&plan, shadows, ambient, raw] {
      kernels::combine_visibility({.width = static_cast<int>(plan.extent().width),
                                   .height = static_cast<int>(plan.extent().height),
                                   .shadows = plan.get(shadows).host(),
                                   .ambient = plan.get(ambient).host(),
                                   .visibility = plan.get(raw).host()});
    });
  };
  declare().read(shadows).read(ambient).write(raw).describe(
      "Shadow (red) and ambient (green) visibility of this frame alone.");
  return raw;
}

gpu::ImageRef denoise_visibility(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Guide& guide, gpu::ImageRef raw) {
  const auto& blurring = in.settings.shadow_blur;
  const bool feedback =
      blurring.enabled && blurring.feedback >= 0 && blurring.feedback < blurring.iterations;

  const Integrated integrated = accumulate_visibility(plan, in, guide, raw, feedback);
  if (!blurring.enabled) return integrated.signal;

  estimate_visibility_variance(plan, in, gbuffer, guide, integrated);
  return blur(
      plan, in, gbuffer, guide, visibility_blur(in), integrated.signal,
      feedback ? std::optional(Feedback{blurring.feedback, integrated.remembered}) : std::nullopt);
}

}  // namespace heliograph::render
