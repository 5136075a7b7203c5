#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render::kernels {

/// shaders/post/mean_weight.comp
template <class Stage>
struct MeanWeightBindings {
  gpu::Read<Stage> radiance;  // rgba32f
  gpu::Read<Stage> mean;      // rgba16f, as filter_mean() leaves it
  gpu::ReadBuffer<Stage, shared::ExposureState> exposure;
  gpu::Write<Stage> weight;  // r32f
};
struct MeanWeightConstants {
  glm::uvec2 shown;  // size of all images, pixels
};
using MeanWeightJob = gpu::HostPass<MeanWeightBindings, MeanWeightConstants>;

/// The weight of the mean in the frame that is shown, by its noise, on all processors, in the
/// widest vectors that they have.
void mean_weight(const MeanWeightJob& job);

}  // namespace heliograph::render::kernels
