// Drawing directions from the specular lobe. `view` and `light` are in the frame of the shading
// normal, which is +z; alpha = roughness^2, along x and along y.
#ifndef HELIOGRAPH_SAMPLING_GLSL
#define HELIOGRAPH_SAMPLING_GLSL
#include "lib/lighting/brdf.glsl"

/// A microfacet normal as seen from `view` (z > 0), drawn from a cap of the sphere (Dupuy and
/// Benyoub 2023). alpha = 0 gives exactly +z.
vec3 sample_visible_normal(vec3 view, vec2 alpha, vec2 u) {
  vec3 stretched = normalize(vec3(alpha * view.xy, view.z));
  float angle = 2.0 * pi * u.x;
  // From the top of the cap, 1, down to its rim, -stretched.z: never quite the rim itself.
  float z = 1.0 - u.y * (1.0 + stretched.z);
  float radius = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  vec3 half_vector = vec3(radius * cos(angle), radius * sin(angle), z) + stretched;
  return normalize(vec3(alpha * half_vector.xy, max(half_vector.z, 1e-7)));
}

vec3 sample_visible_normal(vec3 view, float alpha, vec2 u) {
  return sample_visible_normal(view, vec2(alpha), u);
}

/// Smith's masking of one direction, G1.
float smith_masking(vec3 direction, vec2 alpha) {
  return 2.0 * direction.z / (direction.z + masked_length(direction, alpha));
}

/// Density per solid angle of the reflected direction `light` when its normal came from
/// sample_visible_normal: G1(v) D(h) / (4 n.v).
float visible_normal_pdf(vec3 view, vec3 light, vec2 alpha) {
  vec3 half_vector = normalize(view + light);
  if (half_vector.z <= 0.0) return 0.0;
  return smith_masking(view, alpha) * ggx_distribution(half_vector, alpha) / (4.0 * view.z);
}

/// What a sample weighs apart from Fresnel's term, G2 / G1(v): brdf x cosine / pdf. Directions
/// below the horizon have been masked: 0.
float visible_normal_weight(vec3 view, vec3 light, vec2 alpha) {
  if (light.z <= 0.0) return 0.0;
  float toward_view = masked_length(view, alpha);
  float toward_light = masked_length(light, alpha);
  return light.z * (view.z + toward_view) / (light.z * toward_view + view.z * toward_light);
}

float visible_normal_weight(vec3 view, vec3 light, float alpha) {
  return visible_normal_weight(view, light, vec2(alpha));
}

/// The specular signal is radiance / this: what its noise has to do with the surface's colour is
/// taken out before it is filtered and put back by composition.
vec3 specular_demodulator(SurfaceMaterial m) { return max(m.specular_albedo, vec3(1e-3)); }

/// The lobe's normal, or as close to it as keeps the reflected direction above the triangle (Keller
/// et al. 2017, appendix A.3): rims of coarse meshes and steep texels of normal maps reflect what
/// lies along the surface, instead of nothing.
vec3 reflecting_normal(SurfaceMaterial m, vec3 normal) {
  vec3 reflected = reflect(-m.eye, normal);
  const float least = 0.01;
  float above = dot(reflected, m.geometric);
  if (above >= least || dot(m.eye, m.geometric) <= 0.0) return normal;
  vec3 lifted = normalize(reflected + m.geometric * (least - above));
  return normalize(m.eye + lifted);
}

/// The frame of a specular lobe, whose x is the grain where it has one, and the eye in it.
struct LobeFrame {
  vec3 tangent;
  vec3 bitangent;
  vec3 normal;
  vec3 view;
  vec2 alpha;
};

LobeFrame lobe_frame(SurfaceMaterial m, bool of_coat) {
  LobeFrame f;
  f.normal = reflecting_normal(m, of_coat ? m.coat_normal : m.normal);
  float roughness = of_coat ? m.coat_roughness : m.roughness;
  f.alpha = vec2(roughness * roughness);
  if (!of_coat && has_grain(m)) {
    f.alpha = lobe_alpha(roughness, m.anisotropy);
    f.tangent = grain_about(f.normal, m.grain);
    f.bitangent = cross(f.normal, f.tangent);
  } else {
    orthonormal_basis(f.normal, f.tangent, f.bitangent);
  }
  f.view = normalize(vec3(dot(m.eye, f.tangent), dot(m.eye, f.bitangent),
                          max(dot(m.eye, f.normal), 1e-3)));
  return f;
}

/// One direction of the specular lobe, world space, and what its light is multiplied by: BRDF x cos
/// / pdf. A weight of 0 ends the path: below the horizon of the surface or of its triangle. Of a
/// coated surface one of the two lobes is drawn, in proportion to what each gives back.
struct SpecularSample {
  vec3 direction;
  vec3 weight;
  float density;    // pdf of the sampled lobe x its probability, per solid angle; finite for mirrors
  float roughness;  // of the lobe
};

/// How likely the coat's lobe is drawn.
float coat_share(SurfaceMaterial m) {
  return m.coat_albedo / max(dot(m.specular_albedo, vec3(1.0 / 3.0)), 1e-6);
}

SpecularSample sample_specular(SurfaceMaterial m, vec2 u) {
  SpecularSample s;
  s.roughness = m.roughness;
  float lobe_probability = 1.0;
  bool coated = false;
  if (has_coat(m)) {
    float of_coat = clamp(coat_share(m), 0.05, 0.95);
    coated = u.x < of_coat;
    lobe_probability = coated ? of_coat : 1.0 - of_coat;
    u.x = coated ? u.x / of_coat : (u.x - of_coat) / lobe_probability;
    if (coated) s.roughness = m.coat_roughness;
  }
  LobeFrame f = lobe_frame(m, coated);
  vec3 microfacet = sample_visible_normal(f.view, f.alpha, u);
  float v_dot_h = dot(f.view, microfacet);
  vec3 light = 2.0 * v_dot_h * microfacet - f.view;
  s.direction = normalize(f.tangent * light.x + f.bitangent * light.y + f.normal * light.z);
  bool open = dot(s.direction, m.geometric) > 0.0;
  vec3 reflectance = coated ? vec3(coat_reflectance(m, v_dot_h)) : microfacet_reflectance(m, v_dot_h);
  s.weight = open ? reflectance * (visible_normal_weight(f.view, light, f.alpha) / lobe_probability)
                  : vec3(0.0);
  s.density = lobe_probability * visible_normal_pdf(f.view, light, max(f.alpha, vec2(1e-4)));
  return s;
}

#endif
