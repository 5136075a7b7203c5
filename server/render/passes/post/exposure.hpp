#pragma once

#include "gpu/frame_plan/frame_plan.hpp"

namespace heliograph::render {

struct FrameInputs;

/// What radiance is multiplied with before tone mapping: a shared::ExposureState in `state` for
/// shaders and in `report` for the host.
struct Exposure {
  gpu::BufferRef state;
  gpu::BufferRef report;
};

/// Manual exposure is `exposure.compensation` alone. Automatic exposure meters the picture as
/// present() will show it and approaches what it wants exponentially, from where it was one frame
/// ago; a frame without history starts with what it wants.
Exposure expose(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef hdr, gpu::ImageRef mean);

/// Whether automatic exposure, as of the frame that ran last, is as good as where it wants to be
/// (within a hundredth of a stop).
bool is_settled(const gpu::FramePlan& plan, const Exposure& exposure);

/// What radiance was multiplied with in the frame that ran last.
float exposure_factor(const gpu::FramePlan& plan, const Exposure& exposure);

}  // namespace heliograph::render
