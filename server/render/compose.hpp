#pragma once

#include "render/gbuffer.hpp"

namespace heliograph::render {

/// Analytic direct light x traced visibility + image based light + emission over the background:
/// linear radiance (paper section 3, stage 7).
gpu::ImageRef compose(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer,
                      gpu::ImageRef shadows, gpu::ImageRef ambient, gpu::ImageRef background);

}  // namespace heliograph::render
