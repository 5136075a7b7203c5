#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render::kernels {

/// The signal and what guides its blur at half the size: shaders/denoise/visibility_halve.comp.
template <class Stage>
struct VisibilityHalveBindings {
  gpu::Read<Stage> guide;         // rgba32f
  gpu::Read<Stage> depth_slope;   // rg32f
  gpu::Read<Stage> signal;        // rgba32f
  gpu::Write<Stage> half_guide;   // rgba32f, as the others a texel for each square of 2x2 pixels
  gpu::Write<Stage> half_slope;   // rg32f, from texel to texel
  gpu::Write<Stage> half_signal;  // rgba32f
  gpu::OptionalWrite<Stage> packed_guide, packed_slope;  // of the shader alone
};
using VisibilityHalveJob = FrameJob<VisibilityHalveBindings, shared::AtrousConstants>;

/// What was blurred at half the size, at full size: shaders/denoise/visibility_upsample.comp.
template <class Stage>
struct VisibilityUpsampleBindings {
  gpu::Read<Stage> guide;        // rgba32f
  gpu::Read<Stage> depth_slope;  // rg32f
  gpu::Read<Stage> signal;       // rgba32f, not blurred
  gpu::Read<Stage> half_guide;   // rgba32f
  gpu::Read<Stage> half_signal;  // rgba32f, blurred
  gpu::Write<Stage> denoised;    // rgba32f
};
using VisibilityUpsampleJob = FrameJob<VisibilityUpsampleBindings, shared::AtrousConstants>;

/// On all processors, in the widest vectors that they have. The results agree with the shaders' up
/// to rounding.
void visibility_halve(const VisibilityHalveJob& job);
void visibility_upsample(const VisibilityUpsampleJob& job);

}  // namespace heliograph::render::kernels
