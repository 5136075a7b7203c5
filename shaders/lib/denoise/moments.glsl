// Running means of a signal and its square, and what they tell about its noise.
#ifndef HELIOGRAPH_MOMENTS_GLSL
#define HELIOGRAPH_MOMENTS_GLSL

/// Share of a new sample in a mean over `frames` remembered ones, itself included.
vec2 sample_share(vec2 frames, float longest) { return 1.0 / clamp(frames, vec2(1.0), vec2(longest)); }

/// How many frames of a signal to remember that moves by `motion` of its own width each frame: the
/// twin of server/render/resources/scene_motion.cpp tells why.
float frames_under_motion(float motion) {
  return 1.0 + 0.63 * (pow(clamp(motion, 1e-6, 1.0), -2.0 / 3.0) - 1.0);
}

/// Variance of one sample from its first two moments over `frames` samples, without bias.
vec2 sample_variance(vec2 first, vec2 second, vec2 frames) {
  vec2 known = max(frames, vec2(2.0));
  return max(second - first * first, vec2(0.0)) * known / (known - 1.0);
}

/// Numbers that are none must not spread through filters and histories.
float scrub(float value) { return isnan(value) || isinf(value) ? 0.0 : value; }
vec3 scrub(vec3 value) {
  return any(isnan(value)) || any(isinf(value)) ? vec3(0.0) : value;
}

#endif
