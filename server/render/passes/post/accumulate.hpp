#pragma once

#include "gpu/frame_plan/frame_plan.hpp"

namespace heliograph::render {

struct FrameInputs;

/// The mean of every frame's `sample` since the picture last changed: linear radiance.
gpu::History accumulate(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef sample);

/// The mean's share of the picture that is shown in this frame, 0..1. A picture that moves is what
/// the denoiser makes of it; the longer it rests, the more it is the mean, which converges to the
/// truth. `accumulation.blend_samples` samples after the first both count the same.
float mean_share(const FrameInputs& in);

}  // namespace heliograph::render
