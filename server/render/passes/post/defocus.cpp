#include "render/passes/post/defocus.hpp"

#include "render/kernels/post/defocus.hpp"
#include "render/passes/formats.hpp"
#include "render/passes/frame_inputs.hpp"
#include "shaders/embedded.hpp"

namespace heliograph::render {
namespace {

/// Of frames of this shape, whatever size they are drawn at.
VkExtent2D most_tiles(VkExtent2D extent) {
  constexpr std::uint32_t rounding = 32;
  return {shared::defocus_rows * extent.width / extent.height + rounding, shared::defocus_rows};
}

}  // namespace

Composed defocus(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                 const Composed& composed) {
  if (!in.settings.lens.depth_of_field) return composed;
  const bool denoised = composed.noisy.index != composed.hdr.index;
  const VkExtent2D tiles = most_tiles(plan.extent());
  const gpu::BufferRef reach =
      plan.buffer("defocus.reach", sizeof(float) * tiles.width * tiles.height, formats::storage,
                  gpu::Memory::device);
  plan.pass("defocus.reach", in.program(shaders::defocus_reach))
      .bind<kernels::DefocusReachBindings>({.motion = gbuffer.motion, .reach = reach})
      .dispatch({tiles.width, tiles.height})
      .host(kernels::defocus_reach, in.constants);

  Composed blurred;
  blurred.hdr = blurred.noisy = plan.image(defocus_buffers.hdr.name, formats::four_floats);
  const auto gather = [&](const gpu::ShaderBinary& shader, std::optional<gpu::ImageRef> noisy,
                          std::optional<gpu::ImageRef> blurred_noisy) {
    plan.pass("defocus.gather", in.program(shader))
        .bind<kernels::DefocusGatherBindings>({.motion = gbuffer.motion,
                                               .reach = reach,
                                               .hdr = composed.hdr,
                                               .noisy = noisy,
                                               .blurred = blurred.hdr,
                                               .blurred_noisy = blurred_noisy})
        .dispatch(gpu::each_pixel())
        .host(kernels::defocus_gather, in.constants);
  };
  const auto gather_alone = [&] { gather(shaders::defocus_gather, {}, {}); };
  const auto gather_both = [&] {
    gather(shaders::defocus_gather_denoised, composed.noisy, blurred.noisy);
  };
  if (!denoised) {
    gather_alone();
    return blurred;
  }
  blurred.noisy = plan.image(defocus_buffers.noisy.name, formats::four_floats);
  blurred.makes_noisy = composed.makes_noisy;
  plan.only_when(composed.makes_noisy, gather_both, gather_alone);
  plan.leave_undefined_when_skipped(blurred.noisy);
  return blurred;
}

}  // namespace heliograph::render
