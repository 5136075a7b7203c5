#ifndef HELIOGRAPH_FRAME_BLENDING_GLSL
#define HELIOGRAPH_FRAME_BLENDING_GLSL
#include "lib/frame.glsl"
#include "lib/rays/ray_blending.glsl"

/// RayCount::blending of this frame's streams: another in every frame, so that a mean over frames
/// weights each blended surface by its coverage.
uint frame_blending() {
  if (!scene_has(scene_blends)) return 0u;
  return mixed_bits(frame.sample_index ^ mixed_bits(frame.seed)) | 1u;
}

#endif
