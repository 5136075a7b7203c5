#pragma once

#include "render/passes/denoise/temporal.hpp"

namespace heliograph::render {

/// Indirect diffuse light, accumulated over frames and blurred as far as the settings say.
/// @param noisy  rgba32f: radiance without albedo; w < 0 where no sample was taken
/// @return rgba32f
gpu::ImageRef denoise_indirect(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                               const Guide& guide, gpu::ImageRef noisy);

}  // namespace heliograph::render
