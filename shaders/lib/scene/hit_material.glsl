// What a surface that a ray has met does with light.
#ifndef HELIOGRAPH_HIT_MATERIAL_GLSL
#define HELIOGRAPH_HIT_MATERIAL_GLSL
#include "lib/scene/coverage.glsl"
#include "lib/lighting/environment.glsl"

bool is_unlit(HitSurface s) { return (s.flags & material_unlit) != 0u; }

/// What the surface sends out by itself.
vec3 own_light(HitSurface s) {
  vec3 light = is_unlit(s) ? s.base_color : vec3(0.0);
  return enabled(frame_emissive) ? light + s.emissive : light;
}

SurfaceMaterial material_of(HitSurface s, vec3 direction) {
  return surface_material(s.base_color, s.metallic, s.roughness, s.normal, s.geometric, -direction,
                          s.layer);
}

/// The factor on what is seen through a blended surface.
vec3 seen_behind(HitSurface s, SurfaceMaterial m) {
  return vec3(1.0 - s.alpha) + s.alpha * m.transmitted;
}

/// What the light of a surface weighs that a tracer let stop a ray: rays stop where it covers, less
/// those that its own colour would let through.
float stopped_weight(HitSurface s) { return 1.0 / (1.0 - s.passing); }

#endif
