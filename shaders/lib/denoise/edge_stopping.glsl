// Weights that keep a filter from crossing edges (Schied et al. 2017, equations 3 to 5). All return
// the natural logarithm of the weight, 0 for equal pixels and falling from there, so that their
// product costs one exponential, which edge_weight() takes.
#ifndef HELIOGRAPH_EDGE_STOPPING_GLSL
#define HELIOGRAPH_EDGE_STOPPING_GLSL

/// A float's bits count octaves linearly: those of 1, and how many more are `e` times as much.
const float bits_of_one = 127.0 * 8388608.0;
const float bits_per_exponent = 1.44269504 * 8388608.0;

float weight_of_bits(float bits) { return uintBitsToFloat(uint(max(bits, 0.0))); }
vec2 weight_of_bits(vec2 bits) { return vec2(weight_of_bits(bits.x), weight_of_bits(bits.y)); }

/// exp(exponent) with the fraction of the power of two in place of its own power. 1 for 0, never
/// less than the exponential, at most 6.2 % more. Edges are not known more exactly than that.
float edge_weight(float exponent) {
  return weight_of_bits(exponent * bits_per_exponent + bits_of_one);
}
vec2 edge_weight(vec2 exponent) {
  return vec2(edge_weight(exponent.x), edge_weight(exponent.y));
}

/// Distance of a neighbour's view Z `neighbour_z`, `offset` pixels away, from the plane through the
/// pixel at view Z `z` whose Z changes by `slope` per pixel; metres at the pixel. In perspective
/// 1/Z is linear across the frame, so that planes stay exact at any step; `curve` is 1/z there
/// and 0 in orthographic views.
float plane_distance(float z, vec2 slope, float curve, float neighbour_z, vec2 offset) {
  float rise = dot(slope, offset);
  return abs(neighbour_z * (1.0 - rise * curve) - z - rise * (1.0 - z * curve));
}

/// What a surface may rise per pixel: its own slope, and what is seen as half a slope of one face
/// on; `footprint` is the size of a pixel there, metres.
float depth_allowance(vec2 slope, vec2 offset, float footprint) {
  return abs(dot(slope, offset)) + 0.5 * footprint * length(offset);
}

float depth_exponent(float distance, float allowance, float sigma) {
  return distance > 0.0 ? -distance / max(sigma * allowance, 1e-30) : 0.0;
}

/// log((n_p . n_q)^power) to first order about equal normals: where the next order would show, large
/// powers leave no weight.
float normal_exponent(float cosine, float power) { return power * (cosine - 1.0); }

/// Invisible differences in brightness.
const float smallest_visibility_difference = 1e-3;
const float smallest_radiance_difference = 1e-4;

/// `noise` is the standard deviation of the brightness, `smallest` an invisible difference.
vec2 luminance_exponent(vec2 p, vec2 q, vec2 noise, float sigma, float smallest) {
  return -abs(p - q) / (sigma * noise + smallest);
}

/// Lobes of different widths reflect different parts of the scene.
float roughness_falloff(float p) { return 1.0 / (0.02 + 0.2 * p); }
float roughness_exponent(float p, float q) { return -abs(p - q) * roughness_falloff(p); }

#endif
