// The metallic-roughness BRDF of glTF 2.0 (appendix B): GGX with height-correlated Smith masking,
// Schlick's Fresnel, Lambert below. Perceptual roughness; alpha = roughness^2.
#ifndef HELIOGRAPH_BRDF_GLSL
#define HELIOGRAPH_BRDF_GLSL
#include "lib/geometry.glsl"

vec3 fresnel_schlick(vec3 f0, float cosine) {
  float m = clamp(1.0 - cosine, 0.0, 1.0);
  float m2 = m * m;
  return f0 + (1.0 - f0) * (m2 * m2 * m);
}

float ggx_distribution(float n_dot_h, float alpha) {
  float a2 = alpha * alpha;
  // (n.h)^2 (a^2 - 1) + 1 without cancellation near n.h = 1.
  float d = (1.0 - n_dot_h) * (1.0 + n_dot_h) + n_dot_h * n_dot_h * a2;
  return a2 / (pi * d * d);
}

/// G2 / (4 n.l n.v), height-correlated (Heitz 2014).
float smith_visibility(float n_dot_l, float n_dot_v, float alpha) {
  float a2 = alpha * alpha;
  float v = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2);
  float l = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - a2) + a2);
  return 0.5 / max(v + l, 1e-7);
}

/// BRDF x cos for light arriving along -l.
vec3 shade_light(vec3 base_color, float metallic, float roughness, vec3 f0, vec3 n, vec3 v,
                 vec3 l) {
  float n_dot_l = dot(n, l);
  if (n_dot_l <= 0.0) return vec3(0.0);
  float n_dot_v = max(dot(n, v), 1e-4);
  vec3 h = normalize(l + v);
  float alpha = max(roughness * roughness, 2e-3);  // a point light in a perfect mirror is a pole
  vec3 f = fresnel_schlick(f0, dot(v, h));
  vec3 specular = f * ggx_distribution(clamp(dot(n, h), 0.0, 1.0), alpha) *
                  smith_visibility(n_dot_l, n_dot_v, alpha);
  vec3 diffuse = (1.0 - f) * (1.0 - metallic) * base_color / pi;
  return (specular + diffuse) * n_dot_l;
}

#endif
