#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render::kernels {

/// shaders/post/filter_mean.comp
template <class Stage>
struct FilterMeanBindings {
  gpu::Read<Stage> radiance;  // rgba32f: the denoised frame
  gpu::Read<Stage> mean;      // rgba32f; a: variance of one sample's luminance
  gpu::ReadBuffer<Stage, shared::ExposureState> exposure;
  gpu::Write<Stage> filtered;  // rgba16f; a: standard deviation of its luminance
};
struct FilterMeanConstants {
  glm::uvec2 shown;      // size of all images, pixels
  float variance_scale;  // of one sample's variance to the mean's
  float noise_scale;     // of the filtered mean's variance, as its weights tell it; 0: only a copy
  float prior_share;     // of the surroundings' variance, which a pixel's is at least
};
using FilterMeanJob = gpu::HostPass<FilterMeanBindings, FilterMeanConstants>;

/// The mean, averaged with what differs from it by no more than noise, on all processors, in the
/// widest vectors that they have.
void filter_mean(const FilterMeanJob& job);

}  // namespace heliograph::render::kernels
