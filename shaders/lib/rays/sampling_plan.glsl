// Reading the words of the sampling plan.
#ifndef HELIOGRAPH_SAMPLING_PLAN_GLSL
#define HELIOGRAPH_SAMPLING_PLAN_GLSL
#include "shared/sampling.h"

/// What images of single samples hold where none was taken.
const float no_sample = -1.0;

/// Distance to what a pixel's reflection showed one frame ago, metres; 0: unknown.
float distance_before(uint word) { return uintBitsToFloat(word << 16u); }

#endif
