#pragma once

#include "render/passes/gbuffer/gbuffer.hpp"

namespace heliograph::render {

/// Linear radiance of the environment where no surface was drawn; elsewhere undefined.
gpu::ImageRef draw_skybox(gpu::FramePlan& plan, const FrameInputs& in, const GBuffer& gbuffer);

}  // namespace heliograph::render
