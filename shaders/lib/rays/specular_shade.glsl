// Light that comes back along specular rays: from what they met, or from the environment. Light of
// lights at the hit waits for a shadow ray of its own.
#define TEXTURE_ONE_LEVEL
#include "lib/scene/hit_material.glsl"
#include "lib/lighting/light_choice.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/rays/ray_stream.glsl"
#include "lib/rays/specular_pixels.glsl"
#include "shared/radiance_cache.h"
#include "shared/sampling.h"

layout(set = 1, binding = 0, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, std430) readonly buffer SpecularCount { RayCount specular_count; };
layout(set = 1, binding = 3, std430) readonly buffer SpecularRays { Ray specular_rays[]; };
layout(set = 1, binding = 4, std430) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 5, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 6, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 7, rgba32f) writeonly uniform image2D radiance;
// One frame ago, or anything.
layout(set = 1, binding = 8, rgba32f) readonly uniform image2D previous_motion;
layout(set = 1, binding = 9, r32ui) readonly uniform uimage2D previous_instance;
layout(set = 1, binding = 10, rgba16) readonly uniform image2D visibility;
#ifdef READS_RADIANCE_CACHE
layout(set = 1, binding = 11, std430) buffer Keys { uint cache_keys[]; };
layout(set = 1, binding = 12, std430) buffer Cells { RadianceCell cells[]; };
#endif
layout(push_constant) uniform Constants {
  uint with_lights;  // 0: only the environment lights what is hit
  int scale;
  uint reuse_shadows;  // of the frame before
  uint cached_lights;  // 1: rough surfaces reflect the cache's light of lights
  RadianceCacheConstants cache;
};
#ifdef READS_RADIANCE_CACHE
#include "lib/lighting/radiance_cache.glsl"

/// Whether lights' light at a hit may be that of its cell: a mirror would show the cell.
bool blurs_cell(CachedLight cached, float roughness, float t) {
  float width = roughness * roughness * t;
  return cached_lights != 0u && cached.known && cached.size < width * cell_in_lobe;
}
#endif

/// Light that comes from no light source: without a cache the environment's, as if nothing hid it.
/// `lit`: that of lights, too. `roughness`: of the surface that reflects.
vec3 surrounding_light(HitSurface s, SurfaceMaterial m, float t, float roughness, out bool lit) {
  lit = false;
#ifdef READS_RADIANCE_CACHE
  SeenPlace at = SeenPlace(s.position, s.geometric, dot(s.front, s.geometric) < 0.0);
  CachedLight cached = cached_light(at, t, cache);
  vec3 open = enabled(frame_environment_diffuse) ? environment_irradiance(m.normal) : vec3(0.0);
  vec3 light = reflected_light(m, cached.known ? cached.indirect : open * unknown_openness, open);
  lit = blurs_cell(cached, roughness, t);
  vec3 direct = (wide_albedo(m) + m.specular_albedo) * cached.direct;
  if (scatters_through(m)) {
    CachedLight behind = cached_light(behind_place(at), t, cache);
    open = enabled(frame_environment_diffuse) ? environment_irradiance(-m.normal) : vec3(0.0);
    light += m.diffuse_transmitted * (behind.known ? behind.indirect : open * unknown_openness);
    direct += m.diffuse_transmitted * behind.direct;
    lit = lit && behind.known;
  }
  return lit ? light + direct : light;
#else
  vec3 light = enabled(frame_environment_diffuse) ? environment_diffuse(m) : vec3(0.0);
  if (enabled(frame_environment_specular)) light += environment_specular(m);
  return light;
#endif
}

/// What of a hit's light needs no ray. `lit`: no light needs one.
vec3 steady_light(HitSurface s, SurfaceMaterial m, float t, float roughness, out bool lit) {
  vec3 light = s.base_color;
  lit = (s.flags & material_unlit) != 0u;
  if (!lit) light = surrounding_light(s, m, t, roughness, lit);
  if (enabled(frame_emissive)) light += s.emissive;
  return light;
}

/// Fraction of the lights' radiance that the frame before saw arrive at a point, below 0 where it
/// did not show that.
float shown_shadows(uint instance, vec3 position, vec3 geometric) {
  if (reuse_shadows == 0u) return -1.0;
  vec4 clip = frame.previous_unjittered * vec4(position, 1.0);
  float view_z = -(frame.previous_view * vec4(position, 1.0)).z;
  vec3 eye = frame.inverse_view[3].xyz - position;
  if (enabled(frame_orthographic)) eye = frame.inverse_view[2].xyz;
  if (view_z <= 0.0 || dot(geometric, eye) <= 0.0) return -1.0;
  vec2 at = (clip.xy / clip.w * 0.5 + 0.5) * vec2(frame.extent);
  if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(frame.extent)))) return -1.0;
  ivec2 pixel = ivec2(at);
  if (imageLoad(previous_instance, pixel).r != instance + 1u) return -1.0;
  float shown_z = imageLoad(previous_motion, pixel).w;
  if (abs(shown_z - view_z) > shown_depth_tolerance * view_z) return -1.0;
  return imageLoad(visibility, pixel).x;
}

/// One light with its shadow ray, which carries the light that arrives unless it is occluded.
Ray light_shadow_ray(SurfaceMaterial m, vec3 position, vec3 weight, ivec2 pixel, out bool valid) {
  ivec2 cell = pixel / scale;
  float pick = specular_number(cell, 5u, scale);
  float picks = specular_number(cell, light_picks_dimension, scale);
  LightChoice choice = choose_light(m, position, picks, pick);
  valid = false;
  Ray ray;
  if (choice.total <= 0.0) return ray;
  Light light = light_number(choice.number);
  ray = light_ray(light, m, position, 0.0, specular_pair(cell, 6u, scale), pick, valid);
  vec3 carried = light_contribution(light, m, position) * (choice.total / choice.weight) * weight;
  ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
  ray.user = floatBitsToUint(carried.r);
  ray.padding0 = floatBitsToUint(carried.g);
  ray.padding1 = floatBitsToUint(carried.b);
  // Without shadows every light is visible: an empty interval hits nothing.
  if (!enabled(frame_shadows)) ray.t_max = 0.0;
  return ray;
}

void main() {
  uint index = ray_index();
  bool requested = false;
  Ray shadow;
  if (index < specular_count.count) {
    Ray ray = specular_rays[index];
    Hit hit = hits[index];
    ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
    vec3 weight = uintBitsToFloat(uvec3(ray.user, ray.padding0, ray.padding1));
    vec3 light = vec3(0.0);
    float travelled = distance_of_misses;
    if (hit.instance == hit_none) {
      if (enabled(frame_environment_specular)) light = environment_radiance(ray.direction);
    } else {
      travelled = min(hit.t, farthest_hit);
      float roughness = imageLoad(surface, pixel).x;
      RayCone cone = reflected_cone(camera_cone(), imageLoad(motion, pixel).w, roughness);
      HitSurface s = hit_surface(hit, ray.direction, cone_width(cone, hit.t));
      SurfaceMaterial m = material_of(s, ray.direction);
      if (scene_has(scene_blends)) weight *= stopped_weight(s);
      bool lit;
      light = steady_light(s, m, hit.t, roughness, lit);
      if (with_lights != 0u && enabled(frame_direct) && !lit) {
        float shown = shown_shadows(hit.instance, s.position, s.geometric);
        if (shown >= 0.0) {
          float picks = specular_number(pixel / scale, light_picks_dimension, scale);
          light += direct_light(m, s.position, picks) * shown;
        } else {
          shadow = light_shadow_ray(m, s.position, weight, pixel, requested);
        }
      }
    }
    imageStore(radiance, pixel / scale, vec4(sanitize(light * weight), travelled));
  }
  APPEND_RAY(requested, shadow)
}
