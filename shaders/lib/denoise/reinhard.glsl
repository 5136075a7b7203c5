// Reinhard's curve by luminance, and ways back.
#ifndef HELIOGRAPH_REINHARD_GLSL
#define HELIOGRAPH_REINHARD_GLSL
#include "lib/math/luminance.glsl"

/// c / (1 + k L(c)); the result's luminance is below 1 / k.
vec3 reinhard(vec3 color, float k) { return color / (1.0 + k * luminance(color)); }

/// Exactly back: the compressed luminance is L / (1 + k L).
vec3 inverse_reinhard(vec3 color, float k) {
  return color / (1.0 - min(k * luminance(color), 0.999));
}

/// The paper's, which is not the inverse and shifts brightness (section 3.4).
vec3 paper_inverse_reinhard(vec3 color, float weight) {
  return color * (1.0 + luminance(color)) * weight;
}

#endif
