#include "render/compose.hpp"

#include "render/frame.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {

Composed compose(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                 const RawSignals& raw, const std::optional<DenoisedSignals>& denoised,
                 gpu::ImageRef background) {
  constexpr VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  Composed composed;
  composed.hdr = composed.hdr_raw = plan.image("hdr", format);
  // A binding has to hold an image; one that is not traced is not read.
  const bool mirrors = raw.specular.has_value();
  const gpu::ImageRef specular = raw.specular.value_or(background);
  const auto& shader = denoised ? shaders::compose_denoised : shaders::compose;
  auto pass = plan.pass("compose", in.programs.compute(shader, in.scene.features));
  pass.read(gbuffer.normals)
      .read(gbuffer.base_color)
      .read(gbuffer.surface)
      .read(gbuffer.motion)
      .read(gbuffer.emissive)
      .read(background)
      .read(raw.shadows)
      .read(raw.ambient)
      .read(specular)
      .constants([&s = in.settings.specular, mirrors] { return mirrors ? s.max_roughness : -1.0f; })
      .dispatch(plan.extent());
  if (denoised) {
    composed.hdr_raw = plan.image("hdr_raw", format);
    pass.read(denoised->visibility).read(denoised->specular.value_or(specular));
  }
  pass.write(composed.hdr);
  if (denoised) pass.write(composed.hdr_raw);
  return composed;
}

}  // namespace heliograph::render
