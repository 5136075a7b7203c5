#pragma once

#include "gpu/frame_plan/frame_plan.hpp"

namespace heliograph::render {

struct FrameInputs;

/// The factor of radiance before tone mapping: a shared::ExposureState in `state` for
/// shaders and in `report` for the host.
struct Exposure {
  gpu::BufferRef state;
  gpu::BufferRef report;
};

/// Manual exposure is `exposure.compensation` alone. Automatic exposure meters the frame and the
/// mean, blended by mean_share(), and approaches its target exponentially, from the exposure of the
/// frame before; a frame without history starts at its target.
Exposure expose(gpu::FramePlan& plan, const FrameInputs& in, gpu::ImageRef hdr, gpu::ImageRef mean);

/// Whether automatic exposure has reached its target in the frame that ran last, within a hundredth
/// of a stop.
bool is_settled(const gpu::FramePlan& plan, const Exposure& exposure);

/// The factor of radiance in the frame that ran last.
float exposure_factor(const gpu::FramePlan& plan, const Exposure& exposure);

}  // namespace heliograph::render
