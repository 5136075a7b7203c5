#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/sampling.h"

namespace heliograph::render::kernels {

/// shaders/sampling/sampling_plan.comp
template <class Stage>
struct SamplingPlanBindings {
  gpu::Read<Stage> reprojection;       // rgba32f
  gpu::Read<Stage> surface;            // rgba8
  gpu::Read<Stage> visibility_length;  // rgba16f: histories one frame ago
  gpu::Read<Stage> specular_length;    // rgba16f
  gpu::Read<Stage> specular_distance;  // rgba16f, w: distance to what is reflected
  gpu::Read<Stage> visibility;         // rgba16: shadow, ambient, variances
  gpu::Read<Stage> indirect_length;    // rgba16f, perhaps of half the size; or anything
  gpu::Write<Stage> planned;           // r32ui
};
using SamplingPlanJob = FrameJob<SamplingPlanBindings, shared::SamplingPlanConstants>;

/// Which pixels trace rays in this frame, on all processors, in the widest vectors that they have.
void sampling_plan(const SamplingPlanJob& job);

}  // namespace heliograph::render::kernels
