#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render::kernels {

/// shaders/post/present.comp
template <class Stage>
struct PresentBindings {
  gpu::Read<Stage> radiance;     // rgba32f
  gpu::Read<Stage> mean;         // rgba16f, as filter_mean() leaves it
  gpu::Read<Stage> mean_weight;  // r32f: of `mean`, 0..1; not read where all pixels have one
  gpu::ReadBuffer<Stage, shared::ExposureState> exposure;
  gpu::Write<Stage> output;  // rgba8
};
struct PresentConstants {
  glm::uvec2 shown;  // size of the frame that is shown, pixels
  glm::uvec2 drawn;  // that of `radiance`, whose nearest pixels are shown
  float weight;      // of `mean` in all pixels; below 0: that of `mean_weight`
};
using PresentJob = FrameJob<PresentBindings, PresentConstants>;

/// Exposure, tone map and sRGB encoding on all processors, in the widest vectors that they have.
void present(const PresentJob& job);

}  // namespace heliograph::render::kernels
