#include "render/passes/compose/compose.hpp"

#include "render/kernels/compose.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/resources/lights/light_table.hpp"
#include "render/resources/moving/moving_scene.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

std::uint32_t is_met(const std::function<bool()>& condition) {
  return !condition || condition() ? 1 : 0;
}

}  // namespace

Composed compose(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                 const NoisySignals& signals, const std::optional<DenoisedSignals>& denoised,
                 gpu::ImageRef background, const ComposeConditions& when) {
  constexpr VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  const std::uint32_t features = in.moving.features_without_emission();
  Composed composed;
  composed.hdr = composed.noisy = plan.image(compose_buffers.hdr.name, format);
  if (denoised) {
    composed.noisy = plan.image(compose_buffers.noisy.name, format);
    composed.makes_noisy = when.makes_noisy;
  }
  // Every binding has to hold an image: reflections that are not traced are not read.
  const bool reflects = signals.specular.has_value();
  const gpu::ImageRef specular = signals.specular.value_or(background);
  const gpu::ImageRef indirect = signals.indirect.value_or(background);
  std::optional<gpu::ImageRef> denoised_visibility, denoised_specular, denoised_indirect, noisy;
  if (denoised) {
    denoised_visibility = denoised->visibility;
    denoised_specular = denoised->specular.value_or(specular);
    denoised_indirect = denoised->indirect.value_or(indirect);
    noisy = composed.noisy;
  }
  const auto& shader = denoised ? shaders::compose_denoised : shaders::compose;
  plan.pass("compose", in.program(shader, features))
      .bind<kernels::ComposeBindings>({.normals = gbuffer.normals,
                                       .base_color = gbuffer.base_color,
                                       .surface = gbuffer.surface,
                                       .layers = gbuffer.layers,
                                       .motion = gbuffer.motion,
                                       .emissive = gbuffer.emissive,
                                       .background = background,
                                       .shadows = signals.shadows,
                                       .ambient = signals.ambient,
                                       .specular = specular,
                                       .indirect = indirect,
                                       .denoised_visibility = denoised_visibility,
                                       .denoised_specular = denoised_specular,
                                       .denoised_indirect = denoised_indirect,
                                       .hdr = composed.hdr,
                                       .hdr_noisy = noisy})
      .constants([&s = in.settings.specular, reflects, when] {
        return kernels::ComposeConstants{reflects ? s.max_roughness : -1.0f,
                                         is_met(when.has_background), is_met(when.makes_noisy)};
      })
      .dispatch(gpu::each_pixel())
      .host([in](const kernels::ComposeJob::Pass& pass) {
        const FrameLights lights(in.tables.lights, in.constants,
                                 in.moving.features_without_emission());
        const auto outside = lights.outside();
        const kernels::ReachingLights reaching(outside, in.constants);
        const bool separate_sun = in.settings.environment.separate_sun;
        kernels::compose({pass, in.constants,
                          kernels::has_layers(in.moving.features_without_emission()), reaching,
                          lights.view(), in.lobe_tables(),
                          *in.moving.environment().view(separate_sun).maps.host});
      });
  return composed;
}

}  // namespace heliograph::render
