#pragma once

#include "gpu/memory/image.hpp"
#include "shaders/shared/frame_constants.h"

namespace heliograph::render::kernels {

/// The mapped images that temporal antialiasing reads and writes.
struct AntialiasJob {
  const shared::FrameConstants& frame;
  float blend;  // weight of the new frame
  float clip;   // half width of the box in standard deviations
  bool anti_flicker;
  float exposure;
  int width;
  int height;
  gpu::HostView radiance, motion, history;
  gpu::HostView resolved;  // written
};

/// Blends the frame with those before it on all processors: shaders/post/temporal_antialias.comp in
/// the widest vectors that the processor has.
void temporal_antialias(const AntialiasJob& job);

}  // namespace heliograph::render::kernels
