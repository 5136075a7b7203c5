// The metallic-roughness BRDF of glTF 2.0 (appendix B): GGX with height-correlated Smith masking
// and Schlick's Fresnel above Lambert. It differs from the specification in two points, so that a
// white surface gives back all light, whatever its roughness and metalness: what microfacets
// reflect more than once comes back with the specular lobe (Fdez-Aguera 2019, Turquin 2019), and
// the diffuse lobe gets what the specular lobe as a whole leaves, not what one microfacet leaves.
// Perceptual roughness; alpha = roughness^2. A clear coat (KHR_materials_clearcoat) is one more
// lobe of the same kind, white and without metal; sheen (KHR_materials_sheen) the lobe of Estevez
// and Kulla 2017 with the visibility of Neubelt and Pettineo 2013. Each leaves to what lies under
// it what it does not give back itself. The base's specular lobe may be rougher in one direction,
// its grain (KHR_materials_anisotropy). A fraction of the diffuse light may leave at the other side
// of the wall, which is thin, by a lobe of Lambert's there (KHR_materials_diffuse_transmission).
#ifndef HELIOGRAPH_BRDF_GLSL
#define HELIOGRAPH_BRDF_GLSL
#include "lib/math/geometry.glsl"
#include "shared/scene.h"

const float dielectric_f0 = 0.04;  // index of refraction 1.5

/// What extensions make of a point of a surface.
struct SurfaceLayer {
  vec3 f0;    // reflectance of the dielectric at normal incidence
  float f90;  // at grazing incidence
  vec3 coat_normal;
  float coat;  // fraction of the surface that lies under a clear coat
  float coat_roughness;
  vec3 sheen;
  float sheen_roughness;
  float transmission;  // fraction of what enters the dielectric that is not scattered back
  vec3 transmitted;    // and what comes out of it behind, where the base colour is white
  vec3 grain;                  // direction in which the surface is rougher, unit length
  float anisotropy;            // strength; 0: the surface has no grain
  float diffuse_transmission;  // fraction of the diffuse light that leaves at the other side
  vec3 diffuse_tint;           // and its colour
};

/// A point of a surface as it looks from one direction.
struct SurfaceMaterial {
  vec3 normal;     // shading, unit length
  vec3 geometric;  // of the triangle, on the eye's side
  vec3 eye;        // toward the eye, unit length
  float n_dot_v;   // > 0
  float roughness;
  // Fresnel reflectance: f0 + f90_minus_f0 x (1 - v.h)^5, multiple scattering included.
  vec3 f0;
  vec3 f90_minus_f0;
  vec3 specular_albedo;      // albedo of the specular lobes under uniform white light
  vec3 diffuse_albedo;       // and the diffuse lobe
  vec3 diffuse_transmitted;  // and the diffuse lobe of light from the other side
  vec3 transmitted;          // and what passes straight through
  vec3 coat_normal;
  float coat_n_dot_v;
  float coat_roughness;
  vec2 coat;          // f0 and f90 - f0
  float coat_albedo;  // its part of specular_albedo; 0: there is no coat
  vec3 sheen;         // factor on the lobe; 0: there is none
  float sheen_roughness;
  vec3 sheen_albedo;
  vec3 grain;        // perpendicular to the normal, unit length
  float anisotropy;  // 0: there is no grain
};

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

/// Where to look up the split sum that make_material() needs.
float material_n_dot_v(vec3 normal, vec3 eye) { return clamp(dot(normal, eye), 1e-3, 1.0); }

/// glTF's own model.
SurfaceLayer plain_layer() {
  return SurfaceLayer(vec3(dielectric_f0), 1.0, vec3(0.0, 0.0, 1.0), 0.0, 0.0, vec3(0.0), 0.0, 0.0,
                      vec3(0.0), vec3(1.0, 0.0, 0.0), 0.0, 0.0, vec3(0.0));
}

/// Alpha of the base's specular lobe along the grain and across it (KHR_materials_anisotropy).
vec2 lobe_alpha(float roughness, float anisotropy) {
  float alpha = roughness * roughness;
  return vec2(mix(alpha, 1.0, anisotropy * anisotropy), alpha);
}

/// Of the lobe without grain that stands for one with it in tables of albedos. On average it gives
/// back more, so that nothing is added for what microfacets do not lose; for single directions near
/// the horizon up to 3 % less.
float round_roughness(float roughness, float anisotropy) {
  if (anisotropy <= 0.0) return roughness;
  vec2 alpha = lobe_alpha(roughness, anisotropy);
  return sqrt(sqrt(alpha.x * alpha.y));
}

/// `grain` turned into the plane of `normal`.
vec3 grain_about(vec3 normal, vec3 grain) {
  vec3 along = grain - normal * dot(normal, grain);
  return along * inversesqrt(max(dot(along, along), 1e-12));
}

/// The material toward `eye`, without its sheen and coat. `split` holds scale and bias of F0 at
/// material_n_dot_v() and round_roughness(). glTF mixes a dielectric and a metal; so does each of their
/// lobes.
SurfaceMaterial make_material(vec3 base_color, float metallic, float roughness, vec3 normal,
                              vec3 geometric, vec3 eye, vec2 split, SurfaceLayer layer) {
  SurfaceMaterial m;
  m.normal = normal;
  m.geometric = geometric;
  m.eye = eye;
  m.n_dot_v = material_n_dot_v(normal, eye);
  m.roughness = roughness;
  // 1 + F0 x energy_compensation: the multiple scattering of Turquin 2019, exact for F0 = 1.
  float energy_compensation = 1.0 / max(split.x + split.y, 1e-3) - 1.0;
  vec3 dielectric_scale = 1.0 + layer.f0 * energy_compensation;
  vec3 dielectric = (1.0 - metallic) * dielectric_scale;
  vec3 metal = metallic * (1.0 + base_color * energy_compensation);
  m.f0 = dielectric * layer.f0 + metal * base_color;
  m.f90_minus_f0 = dielectric * (layer.f90 - layer.f0) + metal * (1.0 - base_color);
  m.specular_albedo = m.f0 * (split.x + split.y) + m.f90_minus_f0 * split.y;
  vec3 dielectric_albedo = (layer.f0 * split.x + layer.f90 * split.y) * dielectric_scale;
  float max_albedo = max(dielectric_albedo.r, max(dielectric_albedo.g, dielectric_albedo.b));
  float entering = (1.0 - metallic) * (1.0 - min(max_albedo, 1.0));
  float scattered = entering * (1.0 - layer.transmission);
  m.diffuse_albedo = scattered * (1.0 - layer.diffuse_transmission) * base_color;
  m.diffuse_transmitted = scattered * layer.diffuse_transmission * layer.diffuse_tint;
  m.transmitted = entering * layer.transmitted * base_color;
  m.coat_normal = normal;
  m.coat_n_dot_v = m.n_dot_v;
  m.coat_roughness = 0.0;
  m.coat = vec2(0.0);
  m.coat_albedo = 0.0;
  m.sheen = m.sheen_albedo = vec3(0.0);
  m.sheen_roughness = 0.0;
  m.anisotropy = layer.anisotropy;
  m.grain = layer.anisotropy > 0.0 ? grain_about(normal, layer.grain) : vec3(1.0, 0.0, 0.0);
  return m;
}

/// Dims all that lies under another lobe.
void cover(inout SurfaceMaterial m, float under) {
  m.f0 *= under;
  m.f90_minus_f0 *= under;
  m.specular_albedo *= under;
  m.diffuse_albedo *= under;
  m.diffuse_transmitted *= under;
  m.transmitted *= under;
  m.sheen *= under;
  m.sheen_albedo *= under;
}

/// `albedo` is that of the white lobe at material_n_dot_v() and the sheen's roughness; narrow lobes
/// would give back more than there is, and are scaled down.
void add_sheen(inout SurfaceMaterial m, SurfaceLayer layer, float albedo) {
  vec3 given = layer.sheen * min(albedo, 1.0);
  cover(m, 1.0 - max(given.r, max(given.g, given.b)));
  m.sheen = layer.sheen / max(albedo, 1.0);
  m.sheen_roughness = layer.sheen_roughness;
  m.sheen_albedo = given;
}

/// Lays the coat over the material. `split` is looked up at the coat's roughness and its own n.v.
void add_coat(inout SurfaceMaterial m, SurfaceLayer layer, vec2 split) {
  float energy_compensation = 1.0 / max(split.x + split.y, 1e-3) - 1.0;
  float scale = layer.coat * (1.0 + dielectric_f0 * energy_compensation);
  m.coat_normal = layer.coat_normal;
  m.coat_n_dot_v = material_n_dot_v(layer.coat_normal, m.eye);
  m.coat_roughness = layer.coat_roughness;
  m.coat = scale * vec2(dielectric_f0, 1.0 - dielectric_f0);
  m.coat_albedo = min(m.coat.x * (split.x + split.y) + m.coat.y * split.y, 1.0);
  cover(m, 1.0 - m.coat_albedo);
  m.specular_albedo += m.coat_albedo;
}

bool has_coat(SurfaceMaterial m) { return m.coat_albedo > 0.0; }
bool has_sheen(SurfaceMaterial m) { return m.sheen != vec3(0.0); }
bool has_grain(SurfaceMaterial m) { return m.anisotropy > 0.0; }
bool scatters_through(SurfaceMaterial m) { return m.diffuse_transmitted != vec3(0.0); }

/// What spreads widely of light from everywhere: the diffuse lobe and the sheen.
vec3 wide_albedo(SurfaceMaterial m) {
  return has_sheen(m) ? m.diffuse_albedo + m.sheen_albedo : m.diffuse_albedo;
}

/// The same of light from both sides.
vec3 spread_albedo(SurfaceMaterial m) { return wide_albedo(m) + m.diffuse_transmitted; }

/// Of the narrower specular lobe.
float specular_roughness(SurfaceMaterial m) {
  return has_coat(m) ? min(m.coat_roughness, m.roughness) : m.roughness;
}

/// Part of specular_albedo that is not the coat's.
vec3 under_coat_albedo(SurfaceMaterial m) { return m.specular_albedo - m.coat_albedo; }

/// (1 - v.h)^5
float schlick_weight(float v_dot_h) {
  float x = clamp(1.0 - v_dot_h, 0.0, 1.0);
  float x2 = x * x;
  return x2 * x2 * x;
}

/// What a microfacet under the coat reflects of light that meets it at this cosine.
vec3 microfacet_reflectance(SurfaceMaterial m, float v_dot_h) {
  return m.f0 + m.f90_minus_f0 * schlick_weight(v_dot_h);
}

/// What one of the coat reflects.
float coat_reflectance(SurfaceMaterial m, float v_dot_h) {
  return m.coat.x + m.coat.y * schlick_weight(v_dot_h);
}

/// D V n.l of one lobe. The roughness is bounded below: a punctual light in a perfect mirror is a
/// singularity.
float specular_lobe(float n_dot_h, float n_dot_l, float n_dot_v, float roughness) {
  float alpha = max(roughness * roughness, 2e-3);
  return ggx_distribution(n_dot_h, alpha) * smith_visibility(n_dot_l, n_dot_v, alpha) * n_dot_l;
}

/// GGX with an alpha for x and one for y (Burley 2012); `h` in the frame of the lobe.
float ggx_distribution(vec3 h, vec2 alpha) {
  vec3 stretched = vec3(h.xy / alpha, h.z);
  float d = dot(stretched, stretched);
  return 1.0 / (pi * alpha.x * alpha.y * d * d);
}

/// z of a direction over its masking (Heitz 2014): 1 / z where nothing masks.
float masked_length(vec3 direction, vec2 alpha) {
  return length(vec3(alpha * direction.xy, direction.z));
}

/// D V n.l of the base's lobe, with its grain, for light along -l above the surface.
float base_lobe(SurfaceMaterial m, vec3 l) {
  vec3 h = normalize(l + m.eye);
  float n_dot_l = dot(m.normal, l);
  float n_dot_h = clamp(dot(m.normal, h), 0.0, 1.0);
  if (!has_grain(m)) return specular_lobe(n_dot_h, n_dot_l, m.n_dot_v, m.roughness);
  vec2 alpha = max(lobe_alpha(m.roughness, m.anisotropy), vec2(2e-3));
  vec3 across = cross(m.normal, m.grain);
  vec3 light = vec3(dot(m.grain, l), dot(across, l), n_dot_l);
  vec3 view = vec3(dot(m.grain, m.eye), dot(across, m.eye), m.n_dot_v);
  vec3 middle = vec3(dot(m.grain, h), dot(across, h), n_dot_h);
  float masked = n_dot_l * masked_length(view, alpha) + m.n_dot_v * masked_length(light, alpha);
  return ggx_distribution(middle, alpha) * (0.5 / max(masked, 1e-7)) * n_dot_l;
}

/// The normal about which the eye sees what the base's lobe reflects, as far as one direction can
/// tell: bent along the grain (KHR_materials_anisotropy, image based lighting).
vec3 reflection_normal(SurfaceMaterial m) {
  if (!has_grain(m)) return m.normal;
  vec3 across = cross(m.normal, m.grain);
  vec3 bent = m.eye - across * dot(m.eye, across);
  float straight = 1.0 - m.anisotropy * (1.0 - m.roughness);
  straight *= straight;
  bent *= inversesqrt(max(dot(bent, bent), 1e-12));
  return normalize(mix(bent, m.normal, straight * straight));
}

/// Specular BRDF x cos for light arriving along -l, without the coat.
vec3 specular_light(SurfaceMaterial m, vec3 l) {
  if (dot(m.normal, l) <= 0.0) return vec3(0.0);
  return microfacet_reflectance(m, dot(m.eye, normalize(l + m.eye))) * base_lobe(m, l);
}

float coat_light(SurfaceMaterial m, vec3 l) {
  float n_dot_l = dot(m.coat_normal, l);
  if (n_dot_l <= 0.0) return 0.0;
  vec3 h = normalize(l + m.eye);
  float n_dot_h = clamp(dot(m.coat_normal, h), 0.0, 1.0);
  return coat_reflectance(m, dot(m.eye, h)) *
         specular_lobe(n_dot_h, n_dot_l, m.coat_n_dot_v, m.coat_roughness);
}

const float least_sheen_roughness = 0.07;

/// D V of the white sheen.
float sheen_lobe(float n_dot_h, float n_dot_l, float n_dot_v, float roughness) {
  float r = max(roughness, least_sheen_roughness);
  float sharpness = 1.0 / (r * r);
  float sine2 = max(1.0 - n_dot_h * n_dot_h, 1e-7);
  float distribution = (2.0 + sharpness) * pow(sine2, 0.5 * sharpness) / (2.0 * pi);
  return distribution / (4.0 * max(n_dot_l + n_dot_v - n_dot_l * n_dot_v, 1e-4));
}

/// Sheen's BRDF x cos for light arriving along -l.
vec3 sheen_light(SurfaceMaterial m, vec3 l) {
  float n_dot_l = dot(m.normal, l);
  if (n_dot_l <= 0.0) return vec3(0.0);
  float n_dot_h = clamp(dot(m.normal, normalize(l + m.eye)), 0.0, 1.0);
  return m.sheen * (sheen_lobe(n_dot_h, n_dot_l, m.n_dot_v, m.sheen_roughness) * n_dot_l);
}

/// BRDF x cos for light arriving along -l.
vec3 shade_light(SurfaceMaterial m, vec3 l) {
  float n_dot_l = max(dot(m.normal, l), 0.0);
  vec3 light = specular_light(m, l) + m.diffuse_albedo * (n_dot_l / pi);
  if (has_coat(m)) light += coat_light(m, l);
  if (has_sheen(m)) light += sheen_light(m, l);
  return light;
}

/// BTDF x cos for light arriving along -l from the other side.
vec3 light_through(SurfaceMaterial m, vec3 l) {
  return m.diffuse_transmitted * (max(-dot(m.normal, l), 0.0) / pi);
}

/// For light arriving along -l from either side of the triangle.
vec3 shade_light_of_side(SurfaceMaterial m, vec3 l) {
  if (dot(m.geometric, l) > 0.0) return shade_light(m, l);
  return scatters_through(m) ? light_through(m, l) : vec3(0.0);
}

/// The triangle's normal on the side that is lit from direction `l`.
vec3 lit_side(SurfaceMaterial m, vec3 l) {
  return scatters_through(m) && dot(m.geometric, l) <= 0.0 ? -m.geometric : m.geometric;
}

#endif
