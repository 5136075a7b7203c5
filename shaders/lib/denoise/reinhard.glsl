// Reinhard's curve by luminance, and ways back.
#ifndef HELIOGRAPH_REINHARD_GLSL
#define HELIOGRAPH_REINHARD_GLSL

float reinhard_luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

/// c / (1 + k L(c)); the result's luminance is below 1 / k.
vec3 reinhard(vec3 color, float k) { return color / (1.0 + k * reinhard_luminance(color)); }

/// Exactly back: the compressed luminance is L / (1 + k L).
vec3 inverse_reinhard(vec3 color, float k) {
  return color / (1.0 - min(k * reinhard_luminance(color), 0.999));
}

/// The paper's, which is not the inverse and shifts brightness (section 3.4).
vec3 paper_inverse_reinhard(vec3 color, float weight) {
  return color * (1.0 + reinhard_luminance(color)) * weight;
}

#endif
