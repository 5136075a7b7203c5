// Looking up the environment: one rotation for background, reflection and diffuse light.
#ifndef HELIOGRAPH_ENVIRONMENT_GLSL
#define HELIOGRAPH_ENVIRONMENT_GLSL
#include "lib/lighting/brdf.glsl"
#include "lib/frame.glsl"
#include "lib/math/equirectangular.glsl"
#include "shared/sampling.h"

/// World direction -> direction in the environment's own frame.
vec3 environment_direction(vec3 world) {
  float c = frame.environment_cos;
  float s = frame.environment_sin;
  return vec3(c * world.x - s * world.z, world.y, s * world.x + c * world.z);
}

vec3 world_of_environment(vec3 direction) {
  float c = frame.environment_cos;
  float s = frame.environment_sin;
  return vec3(c * direction.x + s * direction.z, direction.y, c * direction.z - s * direction.x);
}

/// What the eye sees behind the scene: with the sun's disk, where that is the environment. Black
/// where that is hidden.
vec3 environment_background(vec3 world) {
  if (!enabled(frame_environment_visible)) return vec3(0.0);
  vec2 uv = equirectangular_uv(environment_direction(world));
  return textureLod(background_map, uv, 0.0).rgb * frame.background_intensity;
}

/// What lights the scene. Without the sun where it is separated: that is a light of its own.
vec3 environment_radiance(vec3 world) {
  vec2 uv = equirectangular_uv(environment_direction(world));
  return textureLod(environment_map, uv, 0.0).rgb * frame.environment_intensity;
}

/// GGX-prefiltered radiance about the reflected direction `world`.
vec3 environment_reflection(vec3 world, float roughness) {
  float level = roughness * float(frame.prefiltered_levels - 1u);
  return textureLod(prefiltered_environment, environment_direction(world), level).rgb *
         frame.environment_intensity;
}

/// Irradiance / pi of a surface facing `world` (Ramamoorthi and Hanrahan 2001, nine terms).
vec3 environment_irradiance(vec3 world) {
  vec3 n = environment_direction(world);
  vec3 sum = frame.irradiance[0].rgb;
  sum += frame.irradiance[1].rgb * n.y + frame.irradiance[2].rgb * n.z;
  sum += frame.irradiance[3].rgb * n.x + frame.irradiance[4].rgb * (n.x * n.y);
  sum += frame.irradiance[5].rgb * (n.y * n.z);
  sum += frame.irradiance[6].rgb * (3.0 * n.z * n.z - 1.0);
  sum += frame.irradiance[7].rgb * (n.x * n.z);
  sum += frame.irradiance[8].rgb * (n.x * n.x - n.y * n.y);
  return max(sum, vec3(0.0)) * frame.environment_intensity;
}

/// The material of a surface toward `eye`, with the albedos of its lobes looked up.
SurfaceMaterial surface_material(vec3 base_color, float metallic, float roughness, vec3 normal,
                                 vec3 geometric, vec3 eye, SurfaceLayer layer) {
  float n_dot_v = material_n_dot_v(normal, eye);
  vec2 at = vec2(n_dot_v, round_roughness(roughness, layer.anisotropy));
  vec2 split = textureLod(split_sum_table, at, 0.0).rg;
  SurfaceMaterial m =
      make_material(base_color, metallic, roughness, normal, geometric, eye, split, layer);
  // A constant, by which compilers leave out what it needs.
  if (!scene_has(scene_diffuse_transmits)) m.diffuse_transmitted = vec3(0.0);
  if (scene_has(scene_layers) && layer.sheen != vec3(0.0)) {
    add_sheen(m, layer, textureLod(sheen_table, vec2(n_dot_v, layer.sheen_roughness), 0.0).r);
  }
  if (scene_has(scene_layers) && layer.coat > 0.0) {
    at = vec2(material_n_dot_v(layer.coat_normal, eye), layer.coat_roughness);
    add_coat(m, layer, textureLod(split_sum_table, at, 0.0).rg);
  }
  return m;
}

/// The environment's diffuse light, as if nothing hid it. Sheen is wide enough to see it likewise.
vec3 environment_diffuse(SurfaceMaterial m) {
  vec3 light = wide_albedo(m) * environment_irradiance(m.normal);
  if (scatters_through(m)) light += m.diffuse_transmitted * environment_irradiance(-m.normal);
  return light;
}

/// The environment's specular light by the split sum (Karis 2013), without occlusion.
vec3 environment_specular(SurfaceMaterial m) {
  vec3 reflected = reflect(-m.eye, reflection_normal(m));
  vec3 light = under_coat_albedo(m) * environment_reflection(reflected, m.roughness);
  if (has_coat(m)) {
    light += m.coat_albedo *
             environment_reflection(reflect(-m.eye, m.coat_normal), m.coat_roughness);
  }
  return light;
}

/// Specular occlusion from ambient visibility (Lagarde and de Rousiers 2014, section 4.10.2).
float specular_occlusion(float n_dot_v, float visibility, float roughness) {
  float power = exp2(-16.0 * roughness * roughness - 1.0);
  return clamp(pow(n_dot_v + visibility, power) - 1.0 + visibility, 0.0, 1.0);
}

/// What a specular lobe sees, over its albedo, as far as it is known without a ray: the prefiltered
/// environment, and surfaces of a medium colour in its diffuse light where that is occluded.
vec3 expected_reflection(SurfaceMaterial m, float ambient_visibility) {
  vec3 open = vec3(0.0), occluded = vec3(0.0);
  if (enabled(frame_environment_specular)) {
    open = environment_specular(m) / max(m.specular_albedo, vec3(1e-3));
  }
  if (enabled(frame_environment_diffuse)) {
    occluded = expected_albedo * environment_irradiance(reflect(m.eye, m.normal));
  }
  float visible = specular_occlusion(m.n_dot_v, ambient_visibility, m.roughness);
  return mix(occluded, open, visible);
}

#endif
