#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/exposure.h"

namespace heliograph::render::kernels {

/// shaders/post/temporal_antialias.comp
template <class Stage>
struct AntialiasBindings {
  gpu::Read<Stage> radiance, motion;  // rgba32f, of the size that is drawn
  gpu::Read<Stage> history;           // of that which is shown
  gpu::ReadBuffer<Stage, shared::ExposureState> exposure;
  gpu::Write<Stage> resolved;  // rgba32f; a: samples in the mean
};
struct AntialiasConstants {
  glm::uvec2 shown;    // size of the history and the result, pixels
  float blend;         // least weight of the new frame
  float clip;          // half width of the box in standard deviations
  float anti_flicker;  // 1: on
  std::uint32_t hold;  // 1: the history is the result, as in a static view that is path traced
  std::uint32_t has_settled;  // 1: nothing has moved in so many frames that it hardly changes
};
using AntialiasJob = FrameJob<AntialiasBindings, AntialiasConstants>;

/// Blends the frame with those before it on all processors, in the widest vectors that they have.
void temporal_antialias(const AntialiasJob& job);

}  // namespace heliograph::render::kernels
