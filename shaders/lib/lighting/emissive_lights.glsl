// Emissive triangles as lights: points of them drawn by power, and how likely that is.
#ifndef HELIOGRAPH_EMISSIVE_LIGHTS_GLSL
#define HELIOGRAPH_EMISSIVE_LIGHTS_GLSL
#include "lib/scene/hit_material.glsl"

/// A point of an emissive triangle.
struct EmissiveSample {
  vec3 position;  // world
  vec3 normal;    // of the front face
  vec3 emission;  // radiance toward the receiver: 0 where the side that it sees does not shine
  float density;  // per square metre; 0: nothing was drawn
};

/// A point of the square as one of a triangle, as a hit has it: equal areas stay equal, and what
/// is near stays near (Heitz, "A Low-Distortion Map Between Triangle and Square", 2019).
vec2 triangle_of_square(vec2 u) {
  if (u.y > u.x) return vec2(0.5 * u.x, u.y - 0.5 * u.x);
  return vec2(u.x - 0.5 * u.y, 0.5 * u.y);
}

/// Draws a triangle by `pick`, by its power, and a point of it by `within`, by area. A miss where
/// nothing shines.
Hit draw_emissive(vec2 pick, vec2 within) {
  uint count = emissive_header.count;
  if (count == 0u) return Hit(0.0, hit_none, 0u, 0.0, 0.0, 0u, 0u, 0u);
  uint entry = min(uint(pick.x * float(count)), count - 1u);
  if (pick.y >= emissive_triangles[entry].threshold) entry = emissive_triangles[entry].alias;
  vec2 at = triangle_of_square(within);
  return Hit(0.0, emissive_triangles[entry].instance, emissive_triangles[entry].triangle, at.x,
             at.y, 0u, 0u, 0u);
}

/// The share of power of a triangle; 0 of those that are not in the table.
float emissive_probability(uint instance, uint number) {
  if (emissive_header.count == 0u) return 0.0;
  uint first = emissive_first[instance];
  return first == no_emissive ? 0.0 : emissive_triangles[first + number].probability;
}

/// What of the emission arrives from a surface that covers only in part.
float emissive_coverage(HitTriangle t, TextureLookup lookup) {
  uint flags = materials[t.material].flags;
  if ((flags & (material_alpha_mask | material_alpha_blend)) == 0u ||
      (flags & material_whole_alpha) != 0u) {
    return 1.0;
  }
  vec4 tint = vertex_color(t.a) * t.weights.x + vertex_color(t.b) * t.weights.y +
              vertex_color(t.c) * t.weights.z;
  float alpha = materials[t.material].base_color.a * tint.a *
                slot_texel(materials[t.material].base_color_texture, lookup).a;
  if ((flags & material_alpha_blend) != 0u) return alpha;
  return alpha < materials[t.material].alpha_cutoff ? 0.0 : 1.0;
}

/// `point` of draw_emissive() as `receiver` sees it by a cone of this width there and spread.
EmissiveSample emissive_sample(Hit point, vec3 receiver, RayCone cone) {
  EmissiveSample s = EmissiveSample(vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0);
  if (point.instance == hit_none) return s;
  HitTriangle t = load_triangle(point);
  s.position = vec4(triangle_position(t), 1.0) * t.world;
  vec3 across = cross(transform_direction(t, t.b.position - t.a.position),
                      transform_direction(t, t.c.position - t.a.position)) * t.handedness;
  float twice_area = length(across);
  if (twice_area <= 0.0) return s;
  s.normal = across / twice_area;
  s.density = 2.0 * emissive_probability(point.instance, point.triangle) / twice_area;
  vec3 to_receiver = receiver - s.position;
  float away = length(to_receiver);
  float cosine = dot(s.normal, to_receiver) / max(away, 1e-20);
  bool both = (materials[t.material].flags & material_double_sided) != 0u;
  if (cosine <= 0.0 && !both) return s;
  TextureLookup lookup = texture_lookup(t, twice_area, cone_width(cone, away), abs(cosine));
  s.emission = materials[t.material].emissive *
               slot_texel(materials[t.material].emissive_texture, lookup).rgb *
               emissive_coverage(t, lookup);
  return s;
}

/// A density per square metre of points as one per steradian of their directions, seen from
/// `away` metres under this cosine.
float density_of_direction(float density, float away, float cosine) {
  return density * away * away / max(abs(cosine), 1e-6);
}

/// How likely draw_emissive() finds what a ray along `direction` has met, per steradian. 0: never.
float emissive_density(Hit hit, HitSurface s, vec3 direction) {
  if (s.emissive == vec3(0.0) || s.area <= 0.0) return 0.0;
  float density = emissive_probability(hit.instance, hit.triangle) / s.area;
  return density_of_direction(density, hit.t, dot(s.front, direction));
}

/// Whether a ray along `direction` has met a side that shows the surface's emission: the back only
/// of double-sided materials.
bool side_shines(HitSurface s, vec3 direction) {
  return dot(s.front, direction) <= 0.0 || (s.flags & material_double_sided) != 0u;
}

#endif
