#pragma once

#include "render/passes/frame_inputs.hpp"

namespace heliograph::render {

/// Moves camera rays over the aperture of the frame's lens, in place. Nothing without
/// `lens.depth_of_field`.
void spread_over_lens(gpu::FramePlan& plan, const FrameInputs& in, const tracing::RayStream& rays);

}  // namespace heliograph::render
