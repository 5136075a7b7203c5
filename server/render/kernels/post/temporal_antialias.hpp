#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render::kernels {

/// shaders/post/temporal_antialias.comp
template <class Stage>
struct AntialiasBindings {
  gpu::Read<Stage> radiance, motion, history;  // rgba32f
  gpu::ReadBuffer<Stage, shared::ExposureState> exposure;
  gpu::Write<Stage> resolved;  // rgba32f; a: frames in the mean
};
struct AntialiasConstants {
  float blend;         // least weight of the new frame
  float clip;          // half width of the box in standard deviations
  float anti_flicker;  // 1: on
};
using AntialiasJob = FrameJob<AntialiasBindings, AntialiasConstants>;

/// Blends the frame with those before it on all processors, in the widest vectors that they have.
void temporal_antialias(const AntialiasJob& job);

}  // namespace heliograph::render::kernels
