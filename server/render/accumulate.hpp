#pragma once

#include "gpu/frame_plan.hpp"

namespace heliograph::render {

struct FrameInputs;

/// The mean of all samples since the picture last changed: linear radiance.
gpu::History accumulate(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef hdr);

}  // namespace heliograph::render
