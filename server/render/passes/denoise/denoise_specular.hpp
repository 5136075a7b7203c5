#pragma once

#include "render/passes/denoise/reproject.hpp"

namespace heliograph::render {

/// Demodulated reflections (rgb, w: hit distance) without their noise, and the variance left of
/// their luminance (w): the paper's stages 4 and 5 and its sections 3.1 to 3.4.
gpu::ImageRef denoise_specular(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, gpu::ImageRef raw);

}  // namespace heliograph::render
