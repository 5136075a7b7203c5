#pragma once

#include "render/passes/post/exposure.hpp"

namespace heliograph::render {

/// The frame and the mean of its samples by mean_share(), exposure, tone map, sRGB: RGBA8 for
/// encoders (paper section 3, stage 9).
gpu::ImageRef present(gpu::FramePlan& plan, const FrameInputs& in, const Exposure& exposure,
                      gpu::ImageRef radiance, gpu::ImageRef mean);

}  // namespace heliograph::render
