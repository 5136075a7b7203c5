#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render::kernels {

/// shaders/lib/denoise/spatial_variance.glsl
template <class Stage>
struct SpatialVarianceBindings {
  gpu::Read<Stage> guide, depth_slope, moments, history_length;
  gpu::ReadWrite<Stage> signal;
  gpu::OptionalWrite<Stage> history;  // of visibility
};
using SpatialVarianceJob = FrameJob<SpatialVarianceBindings, shared::TemporalConstants>;

/// Gives pixels with a short history the variance of their neighbours on all processors, in the
/// widest vectors that they have.
void visibility_variance(const SpatialVarianceJob& job);
void specular_variance(const SpatialVarianceJob& job);

}  // namespace heliograph::render::kernels
