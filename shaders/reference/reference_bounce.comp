#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// One vertex of a path of full global illumination: what arrives by itself; one light, one emissive
// triangle and the environment in one direction as far as their shadow rays will find; and where
// the path goes on.
#include "lib/lighting/emissive_lights.glsl"
#include "lib/lighting/environment_sampling.glsl"
#include "lib/rays/reference_path.glsl"

layout(set = 1, binding = 0, std430) buffer Rays { Ray rays[]; };
layout(set = 1, binding = 1, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 2, std430) buffer Paths { ReferencePath paths[]; };
layout(set = 1, binding = 3, std430) writeonly buffer ShadowCount { RayCount shadow_count; };
layout(set = 1, binding = 4, std430) writeonly buffer ShadowRays { Ray shadow_rays[]; };
layout(set = 1, binding = 5, std430) writeonly buffer SkyCount { RayCount sky_count; };
layout(set = 1, binding = 6, std430) writeonly buffer SkyRays { Ray sky_rays[]; };
layout(set = 1, binding = 7, std430) writeonly buffer EmissiveCount { RayCount emissive_count; };
layout(set = 1, binding = 8, std430) writeonly buffer EmissiveRays { Ray emissive_rays[]; };
layout(set = 1, binding = 9, rgba32f) uniform image2D reference;
layout(set = 1, binding = 10, std430) readonly buffer Shade { float ground_shade[]; };
layout(push_constant) uniform Constants { ReferenceConstants constants; };
#include "lib/lighting/ground.glsl"

const uint first_roulette = 3u;       // bounce after which dim paths end at random
const float least_roughness = 0.1;  // whose lobe is wide enough to be met by chance

/// Of light that a path meets by chance, where it is also sampled: two ways lead there, each weighed
/// by how likely it is (Veach and Guibas 1995).
float mis_weight(float density, float other) {
  return other > 0.0 ? density / (density + other) : 1.0;
}

vec3 environment_at_miss(ReferencePath path, vec3 direction) {
  if (path.bounces == 0u) return background(direction);
  uint lobe = (path.flags & path_specular) != 0u ? frame_environment_specular
                                                 : frame_environment_diffuse;
  if (!enabled(lobe)) return vec3(0.0);
  float other = path.density > 0.0 ? environment_density(direction) : 0.0;
  return environment_radiance(direction) * mis_weight(path.density, other);
}

/// What a surface sends out by itself.
vec3 own_light_at_hit(ReferencePath path, HitSurface s, Hit hit, vec3 direction) {
  if (is_unlit(s)) return own_light(s);
  if (!side_shines(s, direction)) return vec3(0.0);
  if (!scene_has(scene_emissive) || path.density <= 0.0) return own_light(s);
  return own_light(s) * mis_weight(path.density, emissive_density(hit, s, direction));
}

/// How likely scatter() takes the specular lobe.
float specular_lobe_probability(SurfaceMaterial m) {
  float specular = luminance(m.specular_albedo);
  return specular / max(specular + luminance(wide_albedo(m)), 1e-6);
}

/// BRDF x cos of the lobes that scatter() draws by the cosine: diffuse, sheen.
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
  vec3 normal = reflecting_normal(m, of_coat ? m.coat_normal : m.normal);
  vec3 tangent, bitangent;
  orthonormal_basis(normal, tangent, bitangent);
  float roughness = of_coat ? m.coat_roughness : m.roughness;
  float alpha = roughness * roughness;
  vec3 view = normalize(vec3(dot(m.eye, tangent), dot(m.eye, bitangent),
                             max(dot(m.eye, normal), 1e-3)));
  vec3 light = vec3(dot(l, tangent), dot(l, bitangent), dot(l, normal));
  if (light.z <= 0.0) return SpecularValue(vec3(0.0), 0.0);
  float density = visible_normal_pdf(view, light, alpha);
  float v_dot_h = dot(view, normalize(view + light));
  vec3 reflectance = of_coat ? vec3(coat_reflectance(m, v_dot_h)) : microfacet_reflectance(m, v_dot_h);
  float drawn = has_coat(m) ? clamp(coat_share(m), 0.05, 0.95) : 0.0;
  return SpecularValue(reflectance * (visible_normal_weight(view, light, alpha) * density),
                       density * (of_coat ? drawn : 1.0 - drawn));
}

/// BRDF x cos over the density of `l`, which was drawn with `density` to sample a light, lobe by
/// lobe: each with the weight that scatter() leaves to it.
vec3 scattered_light(SurfaceMaterial m, vec3 l, float density, bool diffuse, bool specular) {
  float specular_probability = specular_lobe_probability(m);
  vec3 sent = vec3(0.0);
  float cosine = dot(l, m.normal);
  if (cosine > 0.0 && diffuse) {
    sent += wide_light(m, l) / (density + (1.0 - specular_probability) * cosine / pi);
  }
  if (m.roughness >= least_roughness && specular) {
    SpecularValue value = specular_value(m, l, false);
    sent += value.reflected / (density + specular_probability * value.density);
  }
  if (has_coat(m) && m.coat_roughness >= least_roughness && specular) {
    SpecularValue value = specular_value(m, l, true);
    sent += value.reflected / (density + specular_probability * value.density);
  }
  return sent;
}

/// Light of the environment from a direction drawn from its own table.
Ray sky_ray(SurfaceMaterial m, vec3 position, vec3 throughput, ivec2 pixel) {
  EnvironmentSample sky = sample_environment(path_pair(pixel, constants.round, 6u),
                                             path_pair(pixel, constants.round, 7u));
  vec3 l = sky.direction;
  if (dot(l, m.geometric) <= 0.0) return no_ray();
  vec3 sent = scattered_light(m, l, sky.density, enabled(frame_environment_diffuse),
                              enabled(frame_environment_specular));
  if (sent == vec3(0.0)) return no_ray();
  Ray ray = ray_from(position, m.geometric, l, 1e30);
  carry(ray, throughput * sent * environment_radiance(l));
  return ray;
}

/// Light of an emissive triangle, drawn by power. `cone` is that of diffuse light's rays.
Ray emissive_ray(SurfaceMaterial m, vec3 position, RayCone cone, vec3 throughput, ivec2 pixel) {
  if (!enabled(frame_emissive)) return no_ray();
  Hit drawn = draw_emissive(path_pair(pixel, constants.round, 8u),
                            path_pair(pixel, constants.round, 9u));
  EmissiveSample light = emissive_sample(drawn, position, cone);
  vec3 l = light.position - position;
  float away = length(l);
  l /= max(away, 1e-20);
  if (light.emission == vec3(0.0) || dot(l, m.geometric) <= 0.0) return no_ray();
  float density = density_of_direction(light.density, away, dot(light.normal, l));
  if (density <= 0.0) return no_ray();
  vec3 sent = scattered_light(m, l, density, true, true);
  if (sent == vec3(0.0)) return no_ray();
  // As far as the triangle, which must not occlude itself.
  Ray ray = ray_from(position, m.geometric, l, away * 0.999);
  carry(ray, throughput * sent * light.emission);
  return ray;
}

Ray light_shadow_ray(SurfaceMaterial m, vec3 position, vec3 throughput, ivec2 pixel) {
  if (!enabled(frame_direct)) return no_ray();
  float pick = path_number(pixel, constants.round, 1u);
  LightChoice choice = choose_light(m, position, pick);
  if (choice.total <= 0.0) return no_ray();
  Light light = light_number(choice.number);
  LightSample s = sample_light(light, position, path_pair(pixel, constants.round, 2u));
  if (dot(s.ray_direction, m.geometric) <= 0.0) return no_ray();
  // Geometry may lie where an area light does and show it: it must not occlude itself.
  Ray ray = ray_from(position, m.geometric, s.ray_direction, s.distance * 0.999);
  vec3 light_sent = light.type >= light_rectangle ? s.irradiance * shade_light(m, s.direction)
                                                  : light_contribution(light, m, position);
  carry(ray, throughput * light_sent * (choice.total / choice.weight));
  if (!enabled(frame_shadows)) ray.t_max = 0.0;
  return ray;
}

/// One of the two lobes, in proportion to what it gives back; false where the path ends.
bool scatter(inout ReferencePath path, SurfaceMaterial m, RayCone cone, float t, ivec2 pixel,
             out vec3 direction) {
  direction = m.normal;
  float specular_probability = specular_lobe_probability(m);
  vec2 u = path_pair(pixel, constants.round, 4u);
  RayCone next;
  if (path_number(pixel, constants.round, 3u) < specular_probability) {
    SpecularSample drawn = sample_specular(m, u);
    direction = drawn.direction;
    path.throughput *= drawn.weight / specular_probability;
    path.flags = path_specular;
    path.density = drawn.roughness >= least_roughness ? specular_probability * drawn.density : 0.0;
    next = reflected_cone(cone, t, drawn.roughness);
  } else {
    direction = sample_cosine(m.normal, u);
    bool open = dot(direction, m.geometric) > 0.0;
    path.throughput *= open ? wide_weight(m, direction) / (1.0 - specular_probability) : vec3(0.0);
    path.flags = 0u;
    path.density = (1.0 - specular_probability) * max(dot(direction, m.normal), 0.0) / pi;
    next = reflected_cone(cone, t, 1.0);
  }
  path.cone_width = next.width;
  path.cone_spread = next.spread;
  path.bounces += 1u;
  float largest = max(path.throughput.r, max(path.throughput.g, path.throughput.b));
  if (path.bounces >= first_roulette) {
    float survival = min(largest, 0.95);
    if (path_number(pixel, constants.round, 5u) >= survival) return false;
    path.throughput /= survival;
  }
  return largest > 0.0;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  uint index = pixel_index(pixel);
  if (index == 0u) shadow_count = dense_stream(frame_blending());
  Ray ray = rays[index];
  if (index == 0u) sky_count = dense_stream(frame_blending());
  if (scene_has(scene_emissive) && index == 0u) emissive_count = dense_stream(frame_blending());
  Ray shadow = no_ray(), sky = no_ray(), emissive = no_ray();
  if (is_wanted(ray)) {
    Hit hit = hits[index];
    ReferencePath path = paths[index];
    vec3 arrived = path.throughput;
    vec3 radiance = vec3(0.0);
    rays[index] = no_ray();
    if (hit.instance == hit_none) {
      radiance = environment_at_miss(path, ray.direction);
      if (path.bounces == 0u) radiance *= ground_factor(ray.origin, ray.direction);
    } else {
      RayCone cone = RayCone(path.cone_width, path.cone_spread);
      HitSurface s = hit_surface(hit, ray.direction, cone_width(cone, hit.t));
      SurfaceMaterial m = material_of(s, ray.direction);
      bool open = path.bounces == 0u && is_open(s, ray.direction);
      if (open || passes_through(s, m, pixel, constants.round, path.throughput)) {
        rays[index] = beyond(ray, hit);
      } else {
        arrived = path.throughput;
        radiance = own_light_at_hit(path, s, hit, ray.direction);
        if (!is_unlit(s)) {
          shadow = light_shadow_ray(m, s.position, arrived, pixel);
          if (path.bounces < constants.limit) {
            sky = sky_ray(m, s.position, arrived, pixel);
            if (scene_has(scene_emissive)) {
              RayCone wide = reflected_cone(cone, hit.t, 1.0);
              emissive = emissive_ray(m, s.position, wide, arrived, pixel);
            }
            vec3 direction;
            if (scatter(path, m, cone, hit.t, pixel, direction)) {
              rays[index] = ray_from(s.position, s.geometric, direction, 1e30);
            }
          }
        }
      }
      paths[index] = path;
    }
    vec3 sum = imageLoad(reference, pixel).rgb + arrived * radiance;
    imageStore(reference, pixel, vec4(sum, 1.0));
  }
  shadow_rays[index] = shadow;
  sky_rays[index] = sky;
  if (scene_has(scene_emissive)) emissive_rays[index] = emissive;
}
