#pragma once

#include "render/passes/denoise/reproject.hpp"

namespace heliograph::render {

/// A signal gathered over frames, in this frame.
struct Integrated {
  gpu::ImageRef signal;   // the mean and the variance of its noise
  gpu::ImageRef moments;  // of single samples
  gpu::ImageRef history;  // frames remembered, and how far rectification moved the mean
  /// What the next frame goes on from: a later pass must write it, unless it is `signal` itself.
  gpu::ImageRef remembered;
};

/// Shadow and ambient visibility (x and y; variances z and w). With `feedback` a later pass writes
/// what is remembered.
Integrated accumulate_visibility(gpu::FramePlan& plan, const FrameInputs& in, const Guide& guide,
                                 gpu::ImageRef raw, bool feedback);

/// Demodulated reflections: rgb, and the variance of their luminance in w. The moments lie beside
/// the frames remembered, z and w of `history`.
Integrated accumulate_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, gpu::ImageRef raw, bool feedback);

/// Gives pixels with a short history the variance of their neighbours (SVGF, section 4.2).
void estimate_visibility_variance(gpu::FramePlan& plan, const FrameInputs& in,
                                  const GBuffer& gbuffer, const Guide& guide,
                                  const Integrated& visibility);
void estimate_specular_variance(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                                const Guide& guide, const Integrated& specular);

}  // namespace heliograph::render
