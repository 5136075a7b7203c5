// Light that passes surfaces: bent by the boundary of a volume, straight through a thin wall
// (KHR_materials_transmission, KHR_materials_volume, KHR_materials_dispersion).
#ifndef HELIOGRAPH_TRANSMISSION_GLSL
#define HELIOGRAPH_TRANSMISSION_GLSL
#include "lib/lighting/lights.glsl"
#include "lib/math/random.glsl"
#include "lib/math/sampling.glsl"
#include "lib/scene/hit_surface.glsl"
#include "shared/transmission.h"

/// Where a ray meets the boundary of a volume.
struct Boundary {
  uint medium;   // number of the volume's layer; 0: no volume lets light in here
  bool leaving;  // the ray comes from within
};

uint layer_number(Hit hit) {
  return materials[meshes[instances[hit.instance].mesh].material].layer;
}

/// The boundary at `hit` of a ray along `direction`. Volumes are closed: their insides are behind
/// the front faces.
Boundary boundary_of(Hit hit, HitSurface s, vec3 direction) {
  if (!scene_has(scene_transmits) || s.layer.transmission <= 0.0) return Boundary(0u, false);
  uint number = layer_number(hit);
  if (layers[number].refraction == 0.0) return Boundary(0u, false);
  return Boundary(number, dot(s.front, direction) > 0.0);
}

/// Whether what is behind a blended surface shows along rays of its own, not straight through it.
bool bends_light(HitSurface s, Boundary boundary) {
  if (!scene_has(scene_transmits) || !enabled(frame_refraction)) return false;
  if (boundary.medium != 0u) return true;
  return s.layer.transmission > 0.0 && s.roughness >= least_blurring_roughness;
}

/// The band of wavelengths that a pixel's ray has in a volume that splits light into its colours:
/// any three pixels in a row or a column have all of them, and so has a pixel in three frames, after
/// which their order is another.
uint pixel_band(uint medium, ivec2 pixel) {
  if (!scene_has(scene_disperses) || layers[medium].dispersion <= 0.0) return 0u;
  uint turn = pcg3d(uvec3(frame.sample_index / 3u, band_dimension, frame.seed)).x % 3u;
  return 1u + (uint(pixel.x + pixel.y) + frame.sample_index % 3u + turn) % 3u;
}

/// Index of refraction for `band`: 1 red, 2 green, 3 blue, 0 all of them. KHR_materials_dispersion:
/// what lies between red and blue is (index - 1) / Abbe number.
float refraction_index(uint medium, uint band) {
  float index = layers[medium].refraction;
  if (band == 0u) return index;
  float half_range = 0.025 * layers[medium].dispersion * (index - 1.0);
  return max(index + half_range * (float(band) - 2.0), 1.0);
}

/// Fraction of light that is left after `distance` metres of a volume.
vec3 left_by_volume(uint medium, float distance) {
  return exp(-layers[medium].attenuation * distance);
}

/// `direction`, or where it lies below the plane of `normal`, what is as far above it.
vec3 above_plane(vec3 direction, vec3 normal) {
  float height = dot(direction, normal);
  return height < 0.0 ? direction - 2.0 * height * normal : direction;
}

/// A microfacet's normal as the eye sees it, world space (Dupuy and Benyoub 2023).
vec3 sample_microfacet(SurfaceMaterial m, vec2 u) {
  vec3 tangent, bitangent;
  orthonormal_basis(m.normal, tangent, bitangent);
  vec3 view = normalize(vec3(dot(m.eye, tangent), dot(m.eye, bitangent),
                             max(dot(m.eye, m.normal), 1e-3)));
  vec3 h = sample_visible_normal(view, m.roughness * m.roughness, u);
  return normalize(tangent * h.x + bitangent * h.y + m.normal * h.z);
}

/// The direction in which the eye's ray goes on behind the surface. `index`: of the volume that it
/// enters, refracted by a microfacet (Walter et al. 2007); 0: a thin wall, which mirrors what a
/// microfacet reflects to its other side. What microfacets send to the wrong side is mirrored at
/// the triangle, so that no light is lost.
vec3 sample_transmitted(SurfaceMaterial m, float index, vec2 u) {
  vec3 h = sample_microfacet(m, u);
  vec3 direction;
  if (index == 0.0) {
    direction = reflect(reflect(-m.eye, h), m.normal);
  } else {
    direction = refract(-m.eye, dot(m.eye, h) < 0.0 ? -h : h, 1.0 / index);
  }
  return above_plane(normalize(direction), -m.geometric);
}

/// `incident` from within a volume of that index, bent by a microfacet: refract() without its zero
/// at the critical angle, where rounding decides.
vec3 refract_outward(vec3 incident, vec3 h, float index) {
  float cosine = -dot(incident, h);
  float outside2 = max(1.0 - index * index * (1.0 - cosine * cosine), 0.0);
  return normalize(index * incident + (index * cosine - sqrt(outside2)) * h);
}

/// Where a path from within a volume goes at its boundary, and the factor on its throughput.
struct Departure {
  vec3 direction;
  vec3 weight;
  bool outside;
  bool diffuse;  // it stays and has been scattered by the surface's diffuse lobe
};

/// One of the three ways, in proportion to what they give: reflection, in total beyond the critical
/// angle, transmission, diffuse scattering. As Fresnel's term Schlick's is taken at the angle
/// outside, so that both sides of the boundary agree. What transmits nothing is a diffuse wall from
/// within.
Departure sample_departure(HitSurface s, SurfaceMaterial m, float index, float pick, vec2 u) {
  vec3 h = sample_microfacet(m, u);
  float v_dot_h = max(dot(m.eye, h), 0.0);
  float outside2 = 1.0 - index * index * (1.0 - v_dot_h * v_dot_h);
  float schlick = schlick_weight(sqrt(max(outside2, 0.0)));
  vec3 dielectric = outside2 <= 0.0 ? vec3(1.0) : s.layer.f0 + (s.layer.f90 - s.layer.f0) * schlick;
  float clear = (1.0 - s.metallic) * s.layer.transmission;
  float entering = 1.0 - min(max(dielectric.r, max(dielectric.g, dielectric.b)), 1.0);
  vec3 reflected = clear * dielectric + s.metallic * s.base_color;
  vec3 transmitted = clear * entering * s.base_color;
  vec3 scattered = (1.0 - s.metallic - clear) * s.base_color;
  float reflects = luminance(reflected), transmits = luminance(transmitted);
  float sum = max(reflects + transmits + luminance(scattered), 1e-6);
  pick *= sum;
  Departure d;
  d.outside = pick >= reflects && pick < reflects + transmits;
  d.diffuse = pick >= reflects + transmits;
  if (d.outside) {
    d.direction = refract_outward(-m.eye, h, index);
    d.weight = transmitted * (sum / max(transmits, 1e-6));
  } else if (d.diffuse) {
    d.direction = sample_cosine(m.normal, u);
    d.weight = scattered * (sum / max(luminance(scattered), 1e-6));
  } else {
    d.direction = reflect(-m.eye, h);
    d.weight = reflected * (sum / max(reflects, 1e-6));
  }
  d.direction = above_plane(d.direction, d.outside ? -m.geometric : m.geometric);
  return d;
}

#endif
