// Exposure as it adapts from frame to frame. Stops are powers of two.
#ifndef HELIOGRAPH_SHARED_EXPOSURE_H
#define HELIOGRAPH_SHARED_EXPOSURE_H
#include "types.h"
SHARED_BEGIN

struct ExposureState {
  float factor;  // radiance x factor is what the tone map sees
  float stops;   // of the factor, without compensation
  float target;  // where they are going
  float unused;
};

// The histogram of log2 luminance that automatic exposure meters.
SHARED_CONSTANT uint exposure_bins = 256u;
SHARED_CONSTANT float exposure_darkest = -12.0f;      // log2; darker pixels are not metered
SHARED_CONSTANT float exposure_bins_per_stop = 8.0f;  // up to 2^20
SHARED_CONSTANT uint exposure_pixel_weight = 256u;  // of one pixel, shared by its two nearest bins

// Stops that automatic exposure keeps to.
SHARED_CONSTANT float exposure_lowest = -18.0f;
SHARED_CONSTANT float exposure_highest = 8.0f;
SHARED_CONSTANT float exposure_middle_grey = 0.18f;

SHARED_END
#endif
