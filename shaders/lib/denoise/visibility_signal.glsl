// Two scalars in one image: shadow and ambient visibility, and the variance of each.
#ifndef HELIOGRAPH_VISIBILITY_SIGNAL_GLSL
#define HELIOGRAPH_VISIBILITY_SIGNAL_GLSL
#include "lib/denoise/edge_stopping.glsl"

const float smallest_difference = smallest_visibility_difference;

vec2 brightness(vec4 signal) { return signal.xy; }
vec2 variance_of(vec4 signal) { return signal.zw; }
vec4 with_variance(vec4 signal, vec2 variance) { return vec4(signal.xy, variance); }
vec4 with_mean(vec4 signal, vec2 mean, vec2 fraction) {
  return vec4(mix(signal.xy, mean, fraction), signal.zw);
}

/// Its history: history length in frames, and moments of single samples.
vec2 frames_of(vec4 history) { return history.xy; }
vec4 moments_of(vec4 texel) { return texel; }
vec2 first_moment(vec4 moments) { return moments.xy; }
vec2 second_moment(vec4 moments) { return moments.zw; }

/// Weighs values and deviations alike.
vec4 weighing(vec2 weight) { return weight.xyxy; }
/// Values are weighed, variances by the square of the weight.
vec4 spread(vec2 weight) { return vec4(weight, weight * weight); }
/// Of a weight: of what all signals have in common, and of the difference in roughness.
vec2 signal_exponent(float common_part, float of_roughness) { return vec2(common_part); }

#endif
