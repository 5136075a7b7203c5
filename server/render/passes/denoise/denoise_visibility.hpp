#pragma once

#include "render/passes/denoise/reproject.hpp"

namespace heliograph::render {

/// Both visibilities in one image, as one signal: shadow x, ambient y. What is no number becomes 0.
gpu::ImageRef combine_visibility(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef shadows,
                                 gpu::ImageRef ambient);

/// The combined visibility without its noise, and the variance left of each (z, w): the paper's
/// stages 4 and 5.
gpu::ImageRef denoise_visibility(gpu::FramePlan& plan, const FrameInputs& in,
                                 const GBuffer& gbuffer, const Guide& guide, gpu::ImageRef raw);

}  // namespace heliograph::render
