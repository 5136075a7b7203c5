// What paths of the reference meet by each lobe of a surface, and how likely it is.
#ifndef HELIOGRAPH_REFERENCE_LOBES_GLSL
#define HELIOGRAPH_REFERENCE_LOBES_GLSL
#include "lib/lighting/lights.glsl"
#include "lib/math/sampling.glsl"

const float least_roughness = 0.1;  // whose lobe is wide enough to be met by chance

/// How likely a path takes each lobe, and the way through the surface.
struct LobeProbabilities {
  float specular;
  float through;
  float behind;  // the diffuse lobe at the other side
  float wide;
};

LobeProbabilities lobe_probabilities(SurfaceMaterial m) {
  float specular = luminance(m.specular_albedo);
  float through = scene_has(scene_transmits) ? luminance(m.transmitted) : 0.0;
  float behind = luminance(m.diffuse_transmitted);
  float sum = max(specular + luminance(wide_albedo(m)) + through + behind, 1e-6);
  LobeProbabilities of;
  of.specular = specular / sum;
  of.through = through / sum;
  of.behind = behind / sum;
  of.wide = 1.0 - of.specular - of.through - of.behind;
  return of;
}

/// BRDF x cos of the lobes that paths draw by the cosine: diffuse, sheen.
vec3 wide_light(SurfaceMaterial m, vec3 l) {
  vec3 light = m.diffuse_albedo * (dot(m.normal, l) / pi);
  return has_sheen(m) ? light + sheen_light(m, l) : light;
}

/// The same over that density.
vec3 wide_weight(SurfaceMaterial m, vec3 l) {
  if (!has_sheen(m)) return m.diffuse_albedo;
  return m.diffuse_albedo + sheen_light(m, l) * (pi / max(dot(m.normal, l), 1e-4));
}

/// What a specular lobe sends to the eye of light along -l, BRDF x cos, and how likely
/// sample_specular() draws it.
struct SpecularValue {
  vec3 reflected;
  float density;
};

SpecularValue specular_value(SurfaceMaterial m, vec3 l, bool of_coat) {
  LobeFrame f = lobe_frame(m, of_coat);
  vec3 light = vec3(dot(l, f.tangent), dot(l, f.bitangent), dot(l, f.normal));
  if (light.z <= 0.0) return SpecularValue(vec3(0.0), 0.0);
  float density = visible_normal_pdf(f.view, light, f.alpha);
  float v_dot_h = dot(f.view, normalize(f.view + light));
  vec3 reflectance =
      of_coat ? vec3(coat_reflectance(m, v_dot_h)) : microfacet_reflectance(m, v_dot_h);
  float drawn = has_coat(m) ? clamp(coat_share(m), 0.05, 0.95) : 0.0;
  return SpecularValue(reflectance * (visible_normal_weight(f.view, light, f.alpha) * density),
                       density * (of_coat ? drawn : 1.0 - drawn));
}

/// BSDF x cos over the density of `l`, which was drawn with `density` to sample a light, lobe by
/// lobe: each with the weight that a path's own choice leaves to it.
vec3 scattered_light(SurfaceMaterial m, vec3 l, float density, bool diffuse, bool specular) {
  LobeProbabilities lobes = lobe_probabilities(m);
  vec3 sent = vec3(0.0);
  if (scatters_through(m) && dot(l, m.geometric) <= 0.0) {
    float cosine = max(-dot(l, m.normal), 0.0);
    if (diffuse) sent = light_through(m, l) / (density + lobes.behind * cosine / pi);
    return sent;
  }
  float cosine = dot(l, m.normal);
  if (cosine > 0.0 && diffuse) {
    sent += wide_light(m, l) / (density + lobes.wide * cosine / pi);
  }
  if (m.roughness >= least_roughness && specular) {
    SpecularValue value = specular_value(m, l, false);
    sent += value.reflected / (density + lobes.specular * value.density);
  }
  if (has_coat(m) && m.coat_roughness >= least_roughness && specular) {
    SpecularValue value = specular_value(m, l, true);
    sent += value.reflected / (density + lobes.specular * value.density);
  }
  return sent;
}

#endif
