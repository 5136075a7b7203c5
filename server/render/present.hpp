#pragma once

#include "gpu/frame_plan.hpp"

namespace heliograph::render {

struct FrameInputs;

/// Exposure, tone map, sRGB: RGBA8 for encoders (paper section 3, stage 9).
gpu::ImageRef present(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef radiance);

}  // namespace heliograph::render
