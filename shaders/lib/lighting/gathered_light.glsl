// What comes back along a ray that gathers indirect light. Include after the cache's buffers.
#ifndef HELIOGRAPH_GATHERED_LIGHT_GLSL
#define HELIOGRAPH_GATHERED_LIGHT_GLSL
#include "lib/lighting/emissive_balance.glsl"
#include "lib/lighting/emissive_lights.glsl"
#include "lib/lighting/radiance_cache.glsl"

/// Width of a gathering ray's cone, metres per metre.
const float gathering_spread = 0.25;

/// What the surface sends out by itself, less what shadow rays toward emissive triangles bring. The
/// ray carries the density of the cosine: guided or not, these weights share out each direction.
vec3 gathered_emission(Ray ray, Hit hit, HitSurface s) {
  if (!scene_has(scene_emissive) || is_unlit(s)) return own_light(s);
  if (!enabled(frame_emissive) || !side_shines(s, ray.direction)) return vec3(0.0);
  return s.emissive * gathered_share(uintBitsToFloat(ray.padding1),
                                     emissive_density(hit, s, ray.direction));
}

/// Radiance; `known` is false where the cache has nothing to say.
vec3 gathered_light(Ray ray, Hit hit, RadianceCacheConstants c, out bool known) {
  known = true;
  if (hit.instance == hit_none) {
    return enabled(frame_environment_diffuse) ? environment_radiance(ray.direction) : vec3(0.0);
  }
  HitSurface s = hit_surface(hit, ray.direction, hit.t * gathering_spread);
  vec3 light = gathered_emission(ray, hit, s);
  if (is_unlit(s)) return light;
  SurfaceMaterial m = material_of(s, -mean_cosine * s.normal);
  SeenPlace at = SeenPlace(s.position, s.geometric, dot(s.front, s.geometric) < 0.0);
  CachedLight cached = cached_light(at, hit.t, c);
  known = cached.known;
  // Specular lobes send on what they get to everywhere, and as much as of light that comes at the
  // mean angle: the eye's own would be right for light from everywhere. Most rays that meet a floor
  // near a wall graze it, where it shines of what is opposite, and not of the sun above it.
  vec3 albedo = wide_albedo(m) + m.specular_albedo;
  light += albedo * (cached.direct + cached.indirect);
  if (scatters_through(m)) {
    CachedLight behind = cached_light(behind_place(at), hit.t, c);
    known = known && behind.known;
    light += m.diffuse_transmitted * (behind.direct + behind.indirect);
  }
  return light * (scene_has(scene_blends) ? stopped_weight(s) : 1.0);
}

#endif
