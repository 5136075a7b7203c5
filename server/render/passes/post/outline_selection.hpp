#pragma once

#include "gpu/frame_plan/frame_plan.hpp"
#include "render/passes/frame_inputs.hpp"

namespace heliograph::render {

/// Draws an outline over the finished frame around the pixels of selected instances, in frames with
/// a selection. `instance`: of the G-buffer; `output`: RGBA8.
///
/// Coverage is a Gaussian mean of the jittered samples by their distance from the pixel, so that it
/// changes smoothly across an edge and hardly at all from frame to frame. What is half covered gets
/// the whole colour: a line of two pixels, without steps.
void outline_selection(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef instance,
                       gpu::ImageRef output);

}  // namespace heliograph::render
