#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// One vertex of a path of full global illumination: what arrives by itself; one light, one emissive
// triangle and the environment in one direction as far as their shadow rays will find; and where
// the path goes on. Light that passes a surface is refracted: the rays to the environment and to
// emissive triangles stop at every blended surface then, and paths find what is behind by chance.
// Lights without a surface, which no path can meet, shine straight through.
#include "lib/lighting/emissive_lights.glsl"
#include "lib/lighting/environment_sampling.glsl"
#include "lib/lighting/transmission.glsl"
#include "lib/rays/reference_lobes.glsl"
#include "lib/rays/reference_path.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) buffer Rays { Ray rays[]; };
layout(set = 1, binding = 1, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 2, std430) buffer Paths { ReferencePath paths[]; };
layout(set = 1, binding = 3, std430) writeonly buffer ShadowCount { RayCount shadow_count; };
layout(set = 1, binding = 4, std430) writeonly buffer ShadowRays { StoredRay shadow_rays[]; };
layout(set = 1, binding = 5, std430) writeonly buffer SkyCount { RayCount sky_count; };
layout(set = 1, binding = 6, std430) writeonly buffer SkyRays { StoredRay sky_rays[]; };
layout(set = 1, binding = 7, std430) writeonly buffer EmissiveCount { RayCount emissive_count; };
layout(set = 1, binding = 8, std430) writeonly buffer EmissiveRays { StoredRay emissive_rays[]; };
layout(set = 1, binding = 9, rgba32f) uniform image2D reference;
layout(set = 1, binding = 10, std430) readonly buffer Shade { float ground_shade[]; };
layout(push_constant) uniform Constants { ReferenceConstants constants; };
#include "lib/lighting/ground.glsl"

const uint first_roulette = 3u;  // bounce after which dim paths end at random

/// Of light that a path meets by chance, where it is also sampled: two ways lead there, each weighed
/// by how likely it is (Veach and Guibas 1995).
float mis_weight(float density, float other) {
  return other > 0.0 ? density / (density + other) : 1.0;
}

uint medium_of(ReferencePath path) { return path.flags >> path_medium_shift; }
uint band_of(ReferencePath path) { return path.flags >> path_band_shift & path_bands; }

void enter_medium(inout ReferencePath path, uint medium) {
  path.flags = (path.flags & ((1u << path_medium_shift) - 1u)) | medium << path_medium_shift;
}

/// Whether the path is still the camera's ray, perhaps refracted.
bool is_seen(ReferencePath path) { return (path.flags & path_turned) == 0u; }

vec3 environment_at_miss(ReferencePath path, vec3 direction) {
  if (is_seen(path)) return environment_background(direction);
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

/// Whether the surface gets light from direction `l`.
bool is_lit_from(SurfaceMaterial m, vec3 l) {
  return scatters_through(m) || dot(l, m.geometric) > 0.0;
}

/// Light of the environment from a direction drawn from its own table.
Ray sky_ray(SurfaceMaterial m, vec3 position, vec3 throughput, ivec2 pixel) {
  EnvironmentSample sky = sample_environment(path_pair(pixel, constants.round, 6u),
                                             path_pair(pixel, constants.round, 7u));
  vec3 l = sky.direction;
  if (!is_lit_from(m, l)) return no_ray();
  vec3 sent = scattered_light(m, l, sky.density, enabled(frame_environment_diffuse),
                              enabled(frame_environment_specular));
  if (sent == vec3(0.0)) return no_ray();
  Ray ray = ray_from(position, lit_side(m, l), l, 1e30);
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
  if (light.emission == vec3(0.0) || !is_lit_from(m, l)) return no_ray();
  float density = density_of_direction(light.density, away, dot(light.normal, l));
  if (density <= 0.0) return no_ray();
  vec3 sent = scattered_light(m, l, density, true, true);
  if (sent == vec3(0.0)) return no_ray();
  // As far as the triangle, which must not occlude itself.
  Ray ray = ray_from(position, lit_side(m, l), l, away * 0.999);
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
  vec3 side = lit_side(m, s.direction);
  if (dot(s.ray_direction, side) <= 0.0) return no_ray();
  // Geometry may lie where an area light does and show it: it must not occlude itself.
  Ray ray = ray_from(position, side, s.ray_direction, s.distance * 0.999);
  vec3 light_sent = light.type >= light_rectangle
                        ? s.irradiance * shade_light_of_side(m, s.direction)
                        : light_contribution(light, m, position);
  carry(ray, throughput * light_sent * (choice.total / choice.weight));
  if (!enabled(frame_shadows)) ray.t_max = 0.0;
  return ray;
}

/// Chooses the path's band of wavelengths where it first meets what bends them differently.
void disperse(inout ReferencePath path, uint medium, ivec2 pixel) {
  if (layers[medium].dispersion <= 0.0 || band_of(path) != 0u) return;
  uint band = min(uint(path_number(pixel, constants.round, 10u) * 3.0), 2u);
  vec3 chosen = vec3(0.0);
  chosen[band] = 3.0;
  path.throughput *= chosen;
  path.flags |= (band + 1u) << path_band_shift;
}

/// Goes on behind the surface: straight or into a volume.
vec3 pass_surface(inout ReferencePath path, SurfaceMaterial m, Boundary boundary, vec2 u,
                  ivec2 pixel) {
  float index = 0.0;
  if (boundary.medium != 0u) {
    disperse(path, boundary.medium, pixel);
    index = refraction_index(boundary.medium, band_of(path));
    enter_medium(path, boundary.medium);
  }
  path.flags |= path_specular;
  path.density = 0.0;
  return sample_transmitted(m, index, u);
}

/// Where a path from within a volume goes at its boundary.
vec3 depart(inout ReferencePath path, HitSurface s, SurfaceMaterial m, uint medium, vec2 u,
            ivec2 pixel) {
  disperse(path, medium, pixel);
  Departure d = sample_departure(s, m, refraction_index(medium, band_of(path)),
                                 path_number(pixel, constants.round, 3u), u);
  path.throughput *= d.weight;
  path.density = 0.0;
  path.flags = (path.flags & ~path_specular) | (d.diffuse ? 0u : path_specular);
  if (!d.outside) {
    path.flags |= path_turned;
    path.bounces += 1u;
  }
  enter_medium(path, d.outside ? 0u : medium);
  return d.direction;
}

/// Reflected by one of the two lobes.
vec3 reflect_path(inout ReferencePath path, SurfaceMaterial m, LobeProbabilities lobes,
                  bool specular, vec2 u, out float roughness) {
  vec3 direction;
  if (specular) {
    SpecularSample drawn = sample_specular(m, u);
    direction = drawn.direction;
    path.throughput *= drawn.weight / lobes.specular;
    path.flags = (path.flags & path_kept) | path_turned | path_specular;
    path.density = drawn.roughness >= least_roughness ? lobes.specular * drawn.density : 0.0;
    roughness = drawn.roughness;
  } else {
    direction = sample_cosine(m.normal, u);
    bool open = dot(direction, m.geometric) > 0.0;
    path.throughput *= open ? wide_weight(m, direction) / max(lobes.wide, 1e-6) : vec3(0.0);
    path.flags = (path.flags & path_kept) | path_turned;
    path.density = lobes.wide * max(dot(direction, m.normal), 0.0) / pi;
    roughness = 1.0;
  }
  path.bounces += 1u;
  return direction;
}

/// Scattered to the other side.
vec3 scatter_through(inout ReferencePath path, SurfaceMaterial m, float probability, vec2 u) {
  vec3 direction = sample_cosine(-m.normal, u);
  bool open = dot(direction, m.geometric) < 0.0;
  path.throughput *= open ? m.diffuse_transmitted / max(probability, 1e-6) : vec3(0.0);
  path.flags = (path.flags & path_kept) | path_turned;
  path.density = probability * max(-dot(direction, m.normal), 0.0) / pi;
  path.bounces += 1u;
  return direction;
}

/// One of the lobes or the way through, in proportion to what it gives; false where the path ends.
bool scatter(inout ReferencePath path, HitSurface s, SurfaceMaterial m, Boundary boundary,
             RayCone cone, float t, ivec2 pixel, out vec3 direction) {
  vec2 u = path_pair(pixel, constants.round, 4u);
  float roughness = m.roughness;
  if (boundary.leaving) {
    direction = depart(path, s, m, boundary.medium, u, pixel);
  } else {
    LobeProbabilities lobes = lobe_probabilities(m);
    float pick = path_number(pixel, constants.round, 3u);
    bool specular = pick < lobes.specular;
    float passing = lobes.specular + lobes.through;
    if (!specular && pick < passing) {
      path.throughput *= m.transmitted / lobes.through;
      direction = pass_surface(path, m, boundary, u, pixel);
    } else if (!specular && scatters_through(m) && pick < passing + lobes.behind) {
      direction = scatter_through(path, m, lobes.behind, u);
      roughness = 1.0;
    } else {
      direction = reflect_path(path, m, lobes, specular, u, roughness);
    }
  }
  RayCone next = reflected_cone(cone, t, roughness);
  path.cone_width = next.width;
  path.cone_spread = next.spread;
  float largest = max(path.throughput.r, max(path.throughput.g, path.throughput.b));
  if (path.bounces >= first_roulette) {
    float survival = min(largest, 0.95);
    if (path_number(pixel, constants.round, 5u) >= survival) return false;
    path.throughput /= survival;
  }
  return largest > 0.0;
}

/// What lights from outside do at a boundary that they reach through the volume: nothing but its
/// diffuse lobe.
void keep_diffuse(inout SurfaceMaterial m) {
  m.f0 = m.f90_minus_f0 = m.specular_albedo = m.sheen = m.sheen_albedo = vec3(0.0);
  m.diffuse_transmitted = vec3(0.0);
  m.coat_albedo = 0.0;
}

/// The surface at `hit` as paths see it. What a volume lets in is attenuated along the way through
/// it, not at its surface.
SurfaceMaterial path_material(inout HitSurface s, vec3 direction) {
  if (scene_has(scene_transmits)) s.layer.transmitted = vec3(s.layer.transmission);
  return material_of(s, direction);
}

/// Whether the ray goes straight on behind the surface that it has met.
bool goes_straight_on(inout ReferencePath path, HitSurface s, Boundary boundary, vec3 direction,
                      ivec2 pixel) {
  // Volumes keep no light of paths that end.
  if (boundary.leaving && path.bounces >= constants.limit) {
    enter_medium(path, 0u);
    return true;
  }
  bool open = is_seen(path) && medium_of(path) == 0u && is_open(s, direction);
  if (open) return true;
  vec3 behind = vec3(1.0 - s.alpha);
  if (!passes_through(s, behind, pixel, constants.round, path.throughput)) return false;
  if (scene_has(scene_transmits)) path.density = 0.0;
  return true;
}

/// The rays that leave a lit surface of a path.
struct LeavingRays {
  Ray shadow;
  Ray sky;
  Ray emissive;
  Ray next;
};

LeavingRays leave_surface(inout ReferencePath path, HitSurface s, SurfaceMaterial m,
                          Boundary boundary, float t, ivec2 pixel) {
  LeavingRays to = LeavingRays(no_ray(), no_ray(), no_ray(), no_ray());
  RayCone cone = RayCone(path.cone_width, path.cone_spread);
  vec3 arrived = path.throughput;
  SurfaceMaterial lit = m;
  if (boundary.leaving) keep_diffuse(lit);
  to.shadow = light_shadow_ray(lit, s.position, arrived, pixel);
  if (path.bounces >= constants.limit) return to;
  if (!boundary.leaving) {
    to.sky = sky_ray(m, s.position, arrived, pixel);
    if (scene_has(scene_emissive)) {
      to.emissive = emissive_ray(m, s.position, reflected_cone(cone, t, 1.0), arrived, pixel);
    }
  }
  vec3 direction;
  if (scatter(path, s, m, boundary, cone, t, pixel, direction)) {
    vec3 side = dot(direction, s.geometric) < 0.0 ? -s.geometric : s.geometric;
    to.next = ray_from(s.position, side, direction, 1e30);
  }
  return to;
}

/// Blended surfaces stop rays that could meet what they look for on a refracted way, too.
uint chance_blending() { return scene_has(scene_transmits) ? 0u : frame_blending(); }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  uint index = pixel_index(pixel);
  if (index == 0u) shadow_count = dense_stream(frame_blending());
  Ray ray = rays[index];
  if (index == 0u) sky_count = dense_stream(chance_blending());
  if (scene_has(scene_emissive) && index == 0u) emissive_count = dense_stream(chance_blending());
  LeavingRays to = LeavingRays(no_ray(), no_ray(), no_ray(), no_ray());
  if (is_wanted(ray)) {
    Hit hit = hits[index];
    ReferencePath path = paths[index];
    vec3 arrived = path.throughput;
    vec3 radiance = vec3(0.0);
    if (hit.instance == hit_none) {
      radiance = environment_at_miss(path, ray.direction);
      if (is_seen(path)) radiance *= ground_factor(ray.origin, ray.direction);
    } else {
      RayCone cone = RayCone(path.cone_width, path.cone_spread);
      HitSurface s = hit_surface(hit, ray.direction, cone_width(cone, hit.t));
      SurfaceMaterial m = path_material(s, ray.direction);
      if (medium_of(path) != 0u) {
        path.throughput *= left_by_volume(medium_of(path), hit.t - ray.t_min);
      }
      Boundary boundary = boundary_of(hit, s, ray.direction);
      // The camera is in no volume: whichever side it sees, it sees from outside.
      boundary.leaving = boundary.leaving && (path.flags & ~path_kept) != 0u;
      if (goes_straight_on(path, s, boundary, ray.direction, pixel)) {
        to.next = beyond(ray, hit);
      } else {
        arrived = path.throughput;
        radiance = own_light_at_hit(path, s, hit, ray.direction);
        if (!is_unlit(s)) to = leave_surface(path, s, m, boundary, hit.t, pixel);
      }
      paths[index] = path;
    }
    rays[index] = to.next;
    vec3 sum = imageLoad(reference, pixel).rgb + arrived * radiance;
    imageStore(reference, pixel, vec4(sum, 1.0));
  }
  shadow_rays[index] = stored(to.shadow);
  sky_rays[index] = stored(to.sky);
  if (scene_has(scene_emissive)) emissive_rays[index] = stored(to.emissive);
}
