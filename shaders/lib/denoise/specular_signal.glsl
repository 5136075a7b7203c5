// Radiance and the variance of its luminance in one image.
#ifndef HELIOGRAPH_SPECULAR_SIGNAL_GLSL
#define HELIOGRAPH_SPECULAR_SIGNAL_GLSL
#include "lib/denoise/edge_stopping.glsl"
#include "lib/math/luminance.glsl"

const float smallest_difference = smallest_radiance_difference;

vec2 brightness(vec4 signal) { return vec2(luminance(signal.rgb)); }
vec2 variance_of(vec4 signal) { return signal.ww; }
vec4 with_variance(vec4 signal, vec2 variance) { return vec4(signal.rgb, variance.x); }
/// Moments know of no colours.
vec4 with_mean(vec4 signal, vec2 mean, vec2 fraction) { return signal; }

/// Its history: history length in frames, and mean and deviation of single samples' luminance.
vec2 frames_of(vec4 history) { return history.xx; }
vec4 moments_of(vec4 texel) { return vec4(texel.xyz, dot(texel.zw, texel.zw)); }
vec2 first_moment(vec4 moments) { return moments.zz; }
vec2 second_moment(vec4 moments) { return moments.ww; }

/// Weighs values and deviations alike.
vec4 weighing(vec2 weight) { return weight.xxxx; }
/// Values are weighed, variances by the square of the weight.
vec4 spread(vec2 weight) { return vec4(weight.xxx, weight.x * weight.x); }
/// Of a weight: of what all signals have in common, and of the difference in roughness.
vec2 signal_exponent(float common_part, float of_roughness) {
  return vec2(common_part + of_roughness);
}

#endif
