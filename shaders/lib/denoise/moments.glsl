// Running means of a signal and its square, and what they tell about its noise.
#ifndef HELIOGRAPH_MOMENTS_GLSL
#define HELIOGRAPH_MOMENTS_GLSL
#include "shared/denoise.h"

/// Weight of a new sample in a mean over a history of `frames`, itself included.
vec2 sample_weight(vec2 frames, float longest) {
  return 1.0 / clamp(frames, vec2(1.0), vec2(longest));
}

/// History length of a signal that moves by `motion` of its own width each frame, in frames;
/// derived in server/render/resources/scene_motion.cpp.
float frames_under_motion(float motion) {
  return 1.0 + motion_history_factor *
                   (pow(clamp(motion, 1e-6, 1.0), motion_history_exponent) - 1.0);
}

/// Variance of one sample from its first two moments over `frames` samples, without bias.
vec2 sample_variance(vec2 first, vec2 second, vec2 frames) {
  vec2 known = max(frames, vec2(2.0));
  return max(second - first * first, vec2(0.0)) * known / (known - 1.0);
}

/// Replaces NaN and infinity by 0, which must not spread through filters and histories.
float sanitize(float value) { return isnan(value) || isinf(value) ? 0.0 : value; }
vec3 sanitize(vec3 value) {
  return any(isnan(value)) || any(isinf(value)) ? vec3(0.0) : value;
}

#endif
