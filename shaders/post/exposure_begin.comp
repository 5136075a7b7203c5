#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/exposure.h"
layout(local_size_x = 64) in;
// Empties the histogram that automatic exposure meters.
layout(set = 1, binding = 0, std430) writeonly buffer Histogram { uint bins[]; };

void main() {
  if (gl_GlobalInvocationID.x < exposure_bins) bins[gl_GlobalInvocationID.x] = 0u;
}
