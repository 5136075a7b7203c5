#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/denoise.h"

namespace heliograph::render::kernels {

/// shaders/denoise/reproject.comp
template <class Stage>
struct ReprojectBindings {
  gpu::Read<Stage> normals, surface, motion, depth_slope, instance;
  gpu::Read<Stage> previous_normals, previous_motion, previous_instance;
  gpu::Write<Stage> guide, reprojection;
  gpu::OptionalWrite<Stage> packed_guide, packed_slope;  // of the shader alone
};
using ReprojectJob = FrameJob<ReprojectBindings, shared::ReprojectConstants>;

/// Finds every surface in the frame before on all processors, in the widest vectors that they have.
void reproject(const ReprojectJob& job);

}  // namespace heliograph::render::kernels
