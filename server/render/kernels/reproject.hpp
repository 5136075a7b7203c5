#pragma once

#include "gpu/memory/image.hpp"
#include "shaders/shared/denoise.h"
#include "shaders/shared/frame_constants.h"

namespace heliograph::render::kernels {

/// The mapped images that reprojection reads and writes.
struct ReprojectJob {
  const shared::FrameConstants& frame;
  shared::ReprojectConstants constants;
  int width;
  int height;
  gpu::HostView normals, surface, motion, depth_slope, instance;
  gpu::HostView previous_normals, previous_motion, previous_instance;
  gpu::HostView guide, reprojection;  // written
};

/// Finds every surface in the frame before on all processors: shaders/denoise/reproject.comp in the
/// widest vectors that the processor has.
void reproject(const ReprojectJob& job);

}  // namespace heliograph::render::kernels
