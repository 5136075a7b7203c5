#pragma once

#include "gpu/memory/image.hpp"
#include "shaders/shared/frame_constants.h"

namespace heliograph::render::kernels {

/// The mapped images that presentation reads and writes.
struct PresentJob {
  const shared::FrameConstants& frame;
  float exposure;
  float mean_share;
  int width;
  int height;
  gpu::HostView radiance, accumulated;
  gpu::HostView picture;  // written, rgba8
};

/// Exposure, tone map and sRGB encoding on all processors: shaders/post/present.comp in the widest
/// vectors that the processor has.
void present(const PresentJob& job);

}  // namespace heliograph::render::kernels
