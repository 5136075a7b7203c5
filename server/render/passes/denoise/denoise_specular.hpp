#pragma once

#include "render/passes/denoise/atrous.hpp"
#include "render/passes/denoise/temporal.hpp"

namespace heliograph::render {

inline constexpr struct DenoiseSpecularBuffers {
  BufferDescription compressed{"specular.compressed", ViewColors::radiance,
                               "Reflections of this frame under Reinhard's curve."};
  BufferDescription expanded{"specular.expanded", ViewColors::radiance,
                             "Denoised reflections as radiance again."};
} denoise_specular_buffers{};

/// Demodulated reflections (rgb, w: hit distance) without their noise, and the variance left of
/// their luminance (w): the paper's stages 4 and 5 and its sections 3.1 to 3.4.
gpu::ImageRef denoise_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, const SampleHistories& histories,
                               gpu::ImageRef noisy);

/// The same up to the blur, which feeds nothing back, and what follows the blur.
SignalBlur specular_to_blur(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                            const Guide& guide, const SampleHistories& histories,
                            gpu::ImageRef noisy);
gpu::ImageRef specular_of_blurred(gpu::FramePlan& plan, const FrameInputs& in,
                                  gpu::ImageRef blurred);

}  // namespace heliograph::render
