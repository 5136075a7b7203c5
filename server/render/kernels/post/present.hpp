#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render::kernels {

/// shaders/post/present.comp
template <class Stage>
struct PresentBindings {
  gpu::Read<Stage> radiance, accumulated;  // rgba32f
  gpu::ReadBuffer<Stage, shared::ExposureState> exposure;
  gpu::Write<Stage> output;  // rgba8
};
struct PresentConstants {
  glm::uvec2 shown;   // size of the frame that is shown, pixels
  glm::uvec2 drawn;   // that of `radiance`, whose nearest pixels are shown
  float mean_weight;  // of the accumulated mean in the image that is shown, 0..1
};
using PresentJob = FrameJob<PresentBindings, PresentConstants>;

/// Exposure, tone map and sRGB encoding on all processors, in the widest vectors that they have.
void present(const PresentJob& job);

}  // namespace heliograph::render::kernels
