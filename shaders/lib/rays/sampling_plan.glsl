// Reading the words of the sampling plan.
#ifndef HELIOGRAPH_SAMPLING_PLAN_GLSL
#define HELIOGRAPH_SAMPLING_PLAN_GLSL
#include "lib/frame.glsl"
#include "shared/sampling.h"

/// What images of single samples hold where none was taken.
const float no_sample = -1.0;

/// Distance to what a pixel's reflection showed one frame ago, metres; 0: unknown.
float distance_before(uint word) { return uintBitsToFloat(word << 16u); }

/// Ambient visibility of a pixel's surface one frame ago.
float ambient_before(uint word) {
  if (!traces_ambient(frame.flags)) return 1.0;
  return float(word >> plan_visibility_shift) / plan_visibility_steps;
}

#endif
