#pragma once

#include "gpu/memory/image.hpp"
#include "render/kernels/atrous.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render::kernels {

/// The mapped images that the spatial estimate of variance reads and writes.
struct SpatialVarianceJob {
  Signal kind;
  const shared::FrameConstants& frame;
  shared::TemporalConstants constants;
  int width;
  int height;
  gpu::HostView guide, depth_slope, moments, history;
  gpu::HostView signal;  // read and written
};

/// Gives pixels with a short history the variance of their neighbours on all processors:
/// shaders/lib/denoise/spatial_variance.glsl in the widest vectors that the processor has.
void spatial_variance(const SpatialVarianceJob& job);

}  // namespace heliograph::render::kernels
