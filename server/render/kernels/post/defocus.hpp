#pragma once

#include "render/kernels/common/frame_job.hpp"
#include "shaders/shared/defocus.h"

/// What a lens does to the frame, on all processors.
namespace heliograph::render::kernels {

/// shaders/post/defocus_reach.comp
template <class Stage>
struct DefocusReachBindings {
  gpu::Read<Stage> motion;  // rgba32f; w: view Z
  gpu::WriteBuffer<Stage, float> reach;
};
using DefocusReachJob = FrameJob<DefocusReachBindings>;
void defocus_reach(const DefocusReachJob& job);

/// shaders/post/defocus_gather.comp and defocus_gather_denoised.comp
template <class Stage>
struct DefocusGatherBindings {
  gpu::Read<Stage> motion;
  gpu::ReadBuffer<Stage, float> reach;
  gpu::Read<Stage> hdr;            // rgba32f
  gpu::OptionalRead<Stage> noisy;  // rgba32f, blurred alike
  gpu::Write<Stage> blurred;       // rgba32f
  gpu::OptionalWrite<Stage> blurred_noisy;
};
using DefocusGatherJob = FrameJob<DefocusGatherBindings>;
void defocus_gather(const DefocusGatherJob& job);

}  // namespace heliograph::render::kernels
