#include "render/passes/compose/compose.hpp"

#include "render/kernels/compose.hpp"
#include "render/passes/frame_inputs.hpp"
#include "render/resources/light_table.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// All that composition touches; a signal that there is none of holds another image.
struct Images {
  GBuffer gbuffer;
  gpu::ImageRef background, shadows, ambient, specular;
  std::optional<DenoisedSignals> denoised;
  Composed composed;
};

/// In the order of the shader's bindings.
gpu::PassBuilder bind(gpu::PassBuilder pass, const Images& images) {
  pass.read(images.gbuffer.normals)
      .read(images.gbuffer.base_color)
      .read(images.gbuffer.surface)
      .read(images.gbuffer.layers)
      .read(images.gbuffer.motion)
      .read(images.gbuffer.emissive)
      .read(images.background)
      .read(images.shadows)
      .read(images.ambient)
      .read(images.specular);
  if (images.denoised) {
    pass.read(images.denoised->visibility)
        .read(images.denoised->specular.value_or(images.specular));
  }
  pass.write(images.composed.hdr);
  if (images.denoised) pass.write(images.composed.hdr_raw);
  return pass;
}

void run_host(const gpu::FramePlan& plan, const FrameInputs& in, const Images& images,
              float max_roughness) {
  const auto view = [&plan](gpu::ImageRef image) { return plan.get(image).host(); };
  const auto lights = frame_lights(in.tables.lights, in.constants);
  const GBuffer& gbuffer = images.gbuffer;
  kernels::ComposeJob job{
      .frame = in.constants,
      .lights = lights,
      .split_sum = in.split_sum_table.host(),
      .split_sum_size = static_cast<int>(in.split_sum_table.desc().extent.width),
      .max_roughness = max_roughness,
      .width = static_cast<int>(plan.extent().width),
      .height = static_cast<int>(plan.extent().height),
      .normals = view(gbuffer.normals),
      .base_color = view(gbuffer.base_color),
      .surface = view(gbuffer.surface),
      .motion = view(gbuffer.motion),
      .emissive = view(gbuffer.emissive),
      .background = view(images.background),
      .shadows = view(images.shadows),
      .ambient = view(images.ambient),
      .specular = view(images.specular),
      .denoised = {},
      .hdr = view(images.composed.hdr)};
  if (images.denoised) {
    job.denoised = {view(images.denoised->visibility),
                    view(images.denoised->specular.value_or(images.specular)),
                    view(images.composed.hdr_raw)};
  }
  kernels::compose(job);
}

}  // namespace

Composed compose(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                 const RawSignals& raw, const std::optional<DenoisedSignals>& denoised,
                 gpu::ImageRef background) {
  constexpr VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  Composed composed;
  composed.hdr = composed.hdr_raw = plan.image("hdr", format);
  if (denoised) composed.hdr_raw = plan.image("hdr_raw", format);
  // A binding has to hold an image; one that is not traced is not read.
  const bool mirrors = raw.specular.has_value();
  const gpu::ImageRef specular = raw.specular.value_or(background);
  const Images images{gbuffer, background, raw.shadows, raw.ambient, specular, denoised, composed};
  const auto roughness = [&s = in.settings.specular, mirrors] {
    return mirrors ? s.max_roughness : -1.0f;
  };
  const bool hosted =
      shades_on_host(plan, in) && (in.scene.features & shared::scene_area_lights) == 0;
  const auto by_host = [in, roughness, hosted] {
    return hosted && kernels::can_compose(in.constants, roughness());
  };
  if (hosted) {
    const auto run = [&plan, in, images, roughness] { run_host(plan, in, images, roughness()); };
    bind(plan.host("compose", run), images).when(by_host);
  }
  const auto& shader = denoised ? shaders::compose_denoised : shaders::compose;
  bind(plan.pass("compose", in.programs.compute(shader, in.scene.features)), images)
      .constants(roughness)
      .dispatch(plan.extent())
      .when([by_host] { return !by_host(); });
  return composed;
}

}  // namespace heliograph::render
