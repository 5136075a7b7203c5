#pragma once

#include "gpu/frame_plan/frame_plan.hpp"

namespace heliograph::render {

struct FrameInputs;

/// In the last frame before the reference takes over: blends the mean into the frame that temporal
/// antialiasing keeps, `resolved`, so that the static view goes on from it. Sizes as shown. Nothing
/// where `antialiasing.temporal` is off.
void hold_mean(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef resolved,
               gpu::ImageRef mean, gpu::ImageRef mean_weight);

}  // namespace heliograph::render
