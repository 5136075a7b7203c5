#pragma once

#include "render/passes/denoise/temporal.hpp"

namespace heliograph::render {

/// Of indirect.half_resolution: a texel for each square of 2x2 pixels.
inline constexpr struct IndirectHalfBuffers {
  BufferDescription normals{"indirect.half.normals", ViewColors::octahedral,
                            "Normals in world space at half the size, octahedral: shading (xy), "
                            "geometric (zw)."};
  BufferDescription motion{"indirect.half.motion", ViewColors::difference,
                           "Motion vectors at half the size, as fractions of width and height; "
                           "view Z now (w), metres."};
  BufferDescription instance{"indirect.half.instance", ViewColors::identity,
                             "Instance + 1 at half the size."};
  BufferDescription surface{"indirect.half.surface", ViewColors::channels,
                            "Roughness as the denoiser of indirect light sees it: 1."};
  BufferDescription depth_slope{"indirect.half.depth_slope", ViewColors::difference,
                                "Change of view Z to the next texel of half the size, metres.",
                                "metres"};
  BufferDescription radiance{"indirect.half.radiance", ViewColors::radiance,
                             "Mean of this frame's samples of indirect light in every square of "
                             "2x2 pixels; negative (w) where there is none."};
  BufferDescription upsampled{"indirect.upsampled", ViewColors::radiance,
                              "Denoised indirect light at full size again, without albedo; "
                              "variance of its brightness (w)."};
} indirect_half_buffers{};

/// Indirect diffuse light, accumulated over frames and blurred as far as the settings say.
/// @param noisy  rgba32f: radiance without albedo; w < 0 where no sample was taken
/// @return rgba32f
gpu::ImageRef denoise_indirect(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, const SampleHistories& histories,
                               gpu::ImageRef noisy);

}  // namespace heliograph::render
