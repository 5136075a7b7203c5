#pragma once

#include <functional>

#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/temporal.hpp"

namespace heliograph::render {

inline constexpr struct DenoiseVisibilityBuffers {
  BufferDescription noisy{"visibility.noisy", ViewColors::channels,
                          "Shadow (red) and ambient (green) visibility of this frame alone."};
} denoise_visibility_buffers{};

/// Of shadow_blur.half_resolution.
inline constexpr struct HalfVisibilityBuffers {
  BufferDescription guide{"visibility.half.guide", ViewColors::direction,
                          "What guides the blur of visibility at half the size: shading normal "
                          "times 1 + roughness; view Z, metres (w)."};
  BufferDescription depth_slope{"visibility.half.depth_slope", ViewColors::difference,
                                "Change of view Z to the next texel of half the size, metres."};
  BufferDescription slope{
      "visibility.half.slope", ViewColors::difference,
      "Change of view Z to the next texel of half the size, in parts of view Z."};
  BufferDescription signal{"visibility.half", ViewColors::channels,
                           "Accumulated shadow (red) and ambient (green) visibility at half the "
                           "size; variances (zw)."};
} half_visibility_buffers{};

/// Both visibilities in one image, as one signal: shadow x, ambient y. NaNs become 0. Beside
/// indirect light there is no ambient visibility: shaders denoise the shadows themselves, and the
/// image is there to be looked at.
/// @param when_read  frames in which it can be; empty: all of them
gpu::ImageRef combine_visibility(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef shadows,
                                 gpu::ImageRef ambient,
                                 const std::function<bool()>& when_read = {});

/// The combined visibility without its noise, and the variance left of each (z, w): the paper's
/// stages 4 and 5.
gpu::ImageRef denoise_visibility(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Guide& guide,
                                 const SampleHistories& histories, gpu::ImageRef noisy);

/// The same up to the blur, which is to be at full size and feeds nothing back.
SignalBlur visibility_to_blur(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                              const Guide& guide, const SampleHistories& histories,
                              gpu::ImageRef noisy);

}  // namespace heliograph::render
