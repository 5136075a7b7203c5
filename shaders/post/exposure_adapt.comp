#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8) in;
// Manual exposure, or adaptation toward the exposure that brings the frame's mean (of the
// logarithm, without the darkest and the brightest twentieth) to middle grey.
#include "lib/frame.glsl"
#include "shared/exposure.h"

layout(set = 1, binding = 0, std430) readonly buffer Histogram { uint bins[]; };
layout(set = 1, binding = 1, std430) buffer State { ExposureState state; };
layout(set = 1, binding = 2, std430) writeonly buffer Report { ExposureState report; };
layout(push_constant) uniform Constants {
  float seconds;     // since the frame before
  float adaptation;  // seconds in which 1 - 1/e of a change is followed
  float reach;       // stops away from manual exposure, at most; 0: it is manual
};

/// Mean log2 luminance of the metered pixels; false where there are none.
bool metered(out float mean) {
  float total = 0.0;
  for (uint i = 0u; i < exposure_bins; ++i) total += float(bins[i]);
  float low = 0.05 * total;
  float high = 0.95 * total;
  float below = 0.0;
  float sum = 0.0;
  float weight = 0.0;
  for (uint i = 0u; i < exposure_bins; ++i) {
    float count = float(bins[i]);
    float inside = max(min(below + count, high) - max(below, low), 0.0);
    below += count;
    sum += inside * float(i);
    weight += inside;
  }
  mean = exposure_darkest + sum / max(weight, 1.0) / exposure_bins_per_stop;
  return weight > 0.0;
}

void main() {
  if (gl_GlobalInvocationID.x > 0u) return;
  ExposureState now = ExposureState(frame.exposure_factor, 0.0, 0.0, 0.0);
  if (reach > 0.0) {
    bool first = frame.history_invalid != 0u;
    float mean;
    now.target = first ? 0.0 : state.target;
    if (metered(mean)) now.target = log2(exposure_middle_grey) - mean;
    now.target = clamp(now.target, exposure_lowest, exposure_highest);
    now.target = clamp(now.target, -reach, reach);
    now.stops = now.target;
    if (!first && adaptation > 0.0) {
      now.stops = mix(now.target, state.stops, exp(-seconds / adaptation));
    }
    now.factor = frame.exposure_factor * exp2(now.stops);
  }
  state = now;
  report = now;
}
