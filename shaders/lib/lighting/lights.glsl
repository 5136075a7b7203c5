// The lights of a scene in world space: KHR_lights_punctual, areas, the environment's sun.
#ifndef HELIOGRAPH_LIGHTS_GLSL
#define HELIOGRAPH_LIGHTS_GLSL
#include "lib/lighting/area_lights.glsl"
#include "lib/lighting/brdf.glsl"
#include "lib/frame.glsl"
#include "lib/math/luminance.glsl"

/// A light as one point of it reaches a surface.
struct LightSample {
  vec3 direction;      // toward the light, unit length: what the surface is shaded with
  float distance;      // metres
  vec3 irradiance;     // on a surface facing `direction`, unshadowed
  vec3 ray_direction;  // toward the point of the light that a shadow ray looks for
};

Light environment_sun() {
  Light light;
  light.position = vec3(0.0);
  light.type = light_directional;
  light.direction = -frame.sun_direction;
  light.range = 0.0;
  light.color = frame.sun_irradiance;
  light.radius = frame.sun_radius;
  light.tangent = vec3(0.0);
  light.half_width = light.half_height = 0.0;
  light.spot_scale = light.spot_offset = 0.0;
  light.padding0 = 0.0;
  return light;
}

Light light_of_texels(uint number) {
  int texel = int(number * texels_per_light);
  uvec4 t0 = texelFetch(light_texels, texel);
  vec4 t1 = uintBitsToFloat(texelFetch(light_texels, texel + 1));
  vec4 t2 = uintBitsToFloat(texelFetch(light_texels, texel + 2));
  vec4 t3 = uintBitsToFloat(texelFetch(light_texels, texel + 3));
  vec4 t4 = uintBitsToFloat(texelFetch(light_texels, texel + 4));
  return Light(uintBitsToFloat(t0.xyz), t0.w, t1.xyz, t1.w, t2.xyz, t2.w, t3.xyz, t3.w, t4.x, t4.y,
               t4.z, t4.w);
}

/// The light number `number` of frame.light_count; the environment's sun comes last, where it has one.
Light light_number(uint number) {
  Light light;
  if (number + 1u == frame.light_count && frame.sun_radius >= 0.0) {
    light = environment_sun();
  } else if (!scene_has(scene_many_lights) || number < uniform_lights) {
    light = lights[min(number, uniform_lights - 1u)];
  } else {
    light = light_of_texels(number);
  }
  if (light.type == light_directional && frame.directional_light_radius >= 0.0) light.radius = frame.directional_light_radius;
  return light;
}

/// Whether any light of number `number` arrives at `position`: reads no more of it than where it is
/// and how far it reaches, so that loops pay little for what is far away.
bool light_reaches(uint number, vec3 position) {
  vec3 middle;
  float range;
  uint type;
  if (!scene_has(scene_many_lights) || number < uniform_lights) {
    uint held = min(number, uniform_lights - 1u);
    middle = lights[held].position;
    range = lights[held].range;
    type = lights[held].type;
  } else {
    int texel = int(number * texels_per_light);
    uvec4 first = texelFetch(light_texels, texel);
    middle = uintBitsToFloat(first.xyz);
    type = first.w;
    range = uintBitsToFloat(texelFetch(light_texels, texel + 1).w);
  }
  bool sun = number + 1u == frame.light_count && frame.sun_radius >= 0.0;
  vec3 to_light = middle - position;
  return sun || type == light_directional || range <= 0.0 ||
         dot(to_light, to_light) < range * range;
}

bool has_area(Light light) {
  return scene_has(scene_area_lights) && light.type >= light_rectangle;
}

/// A punctual light's middle.
LightSample light_at(Light light, vec3 position) {
  LightSample s;
  if (light.type == light_directional) {
    s.direction = s.ray_direction = -light.direction;
    s.distance = 1e30;
    s.irradiance = light.color;
    return s;
  }
  vec3 to_light = light.position - position;
  float squared = max(dot(to_light, to_light), 1e-8);
  s.distance = sqrt(squared);
  s.direction = s.ray_direction = to_light / s.distance;
  float attenuation = 1.0 / squared;
  if (light.range > 0.0) {
    float q = squared / (light.range * light.range);
    attenuation *= clamp(1.0 - q * q, 0.0, 1.0);
  }
  if (light.type == light_spot) {
    float cone = clamp(dot(light.direction, -s.direction) * light.spot_scale + light.spot_offset,
                       0.0, 1.0);
    attenuation *= cone * cone;
  }
  s.irradiance = light.color * attenuation;
  return s;
}

/// A random point of any light. The mean over `u` of irradiance x BRDF x cos is the unshadowed
/// light of an area; punctual lights are shaded from their middle, and only their shadow ray looks
/// for a point of their disk.
LightSample sample_light(Light light, vec3 position, vec2 u) {
  LightSample s;
  if (has_area(light)) {
    AreaSample area = sample_area(light, position, u);
    s.direction = s.ray_direction = area.direction;
    s.distance = area.distance;
    s.irradiance = light.color * area.solid_angle;
    return s;
  }
  s = light_at(light, position);
  float spread = light.type == light_directional ? light.radius : light.radius / s.distance;
  vec3 tangent, bitangent;
  orthonormal_basis(s.direction, tangent, bitangent);
  vec2 disk = sample_disk(u) * spread;
  s.ray_direction = normalize(s.direction + tangent * disk.x + bitangent * disk.y);
  return s;
}

/// Light that a surface sends to the eye from this light, unshadowed, where light_reaches():
/// radiance. Areas by linearly transformed cosines.
vec3 light_contribution(Light light, SurfaceMaterial m, vec3 position) {
  if (has_area(light)) {
    vec2 fractions = area_light_shares(light, m.normal, m.eye, m.n_dot_v, m.roughness, position);
    if (has_grain(m)) {
      vec3 bent = reflection_normal(m);
      fractions.y = area_light_shares(light, bent, m.eye, material_n_dot_v(bent, m.eye),
                                      m.roughness, position).y;
    }
    vec3 energy = wide_albedo(m) * fractions.x + under_coat_albedo(m) * fractions.y;
    if (has_coat(m)) {
      energy += m.coat_albedo * area_light_shares(light, m.coat_normal, m.eye, m.coat_n_dot_v,
                                                  m.coat_roughness, position).y;
    }
    if (scatters_through(m)) {
      energy += m.diffuse_transmitted * area_light_shares(light, -m.normal, m.eye, m.n_dot_v,
                                                          m.roughness, position).x;
    }
    return light.color * energy;
  }
  LightSample s = light_at(light, position);
  return s.irradiance * shade_light_of_side(m, s.direction);
}

/// Light that a surface sends to the eye from all lights, unshadowed.
vec3 direct_light(SurfaceMaterial m, vec3 position) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.light_count; ++i) {
    if (light_reaches(i, position)) sum += light_contribution(light_number(i), m, position);
  }
  return sum;
}

#endif
