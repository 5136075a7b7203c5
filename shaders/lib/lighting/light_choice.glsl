// Choosing lights, and points of lights, in proportion to what they send to the eye.
#ifndef HELIOGRAPH_LIGHT_CHOICE_GLSL
#define HELIOGRAPH_LIGHT_CHOICE_GLSL
#include "lib/lighting/light_grid.glsl"
#include "shared/ray.h"

const uint area_candidates = 4u;

/// Reservoir sampling: `pick` decides by the candidate's fraction of the total and stays uniform.
bool takes(float weight, inout float total, inout float pick) {
  if (!(weight > 0.0)) return false;
  total += weight;
  float probability = weight / total;
  bool chosen = pick < probability;
  pick = chosen ? pick / probability : (pick - probability) / (1.0 - probability);
  return chosen;
}

struct LightChoice {
  uint number;
  float weight;  // luminance of its own unshadowed contribution
  float total;   // of all lights; 0: there is none to choose
};

LightChoice choose_light(SurfaceMaterial m, vec3 position, inout float pick) {
  LightChoice choice = LightChoice(0u, 0.0, 0.0);
  for (uint i = 0u; i < frame.light_count; ++i) {
    if (!light_reaches(i, position)) continue;
    float weight = luminance(light_contribution(light_number(i), m, position));
    if (!takes(weight, choice.total, pick)) continue;
    choice.number = i;
    choice.weight = weight;
  }
  return choice;
}

/// The same among the lights that count where the surface lies. `picks` in [0, 1) says which stand
/// for others.
LightChoice choose_light(SurfaceMaterial m, vec3 position, float picks, inout float pick) {
  if (!uses_light_grid()) return choose_light(m, position, pick);
  LightChoice choice = LightChoice(0u, 0.0, 0.0);
  CellLights cell = cell_lights(position);
  uint outside = outside_count(cell);
  for (uint i = 0u; i < outside + most_light_entries; ++i) {
    EntryLight entry = i < outside ? EntryLight(outside_light(cell, i), 1.0)
                                   : entry_light(cell, i - outside, picks);
    if (entry.weight == 0.0) break;
    if (!light_reaches(entry.number, position)) continue;
    float weight = luminance(light_contribution(light_number(entry.number), m, position));
    if (!takes(weight * entry.weight, choice.total, pick)) continue;
    choice.number = entry.number;
    choice.weight = weight;
  }
  return choice;
}

/// A point of an area light in proportion to the light that it sends to the eye, near enough: one
/// of a few (resampling; Talbot et al. 2005), so that visibility stays 0 or 1 and what is lit
/// everywhere stays free of noise.
LightSample sample_lit_point(Light light, SurfaceMaterial m, vec3 position, vec2 u, float pick,
                             out bool valid) {
  LightSample chosen;
  float total = 0.0;
  for (uint i = 0u; i < area_candidates; ++i) {
    // Steps of the R2 sequence (Roberts 2018).
    vec2 at = fract(u + float(i) * vec2(0.7548776662, 0.5698402910));
    LightSample s = sample_light(light, position, at);
    float weight = luminance(s.irradiance * shade_light_of_side(m, s.direction));
    if (takes(weight, total, pick)) chosen = s;
  }
  valid = total > 0.0;
  return chosen;
}

/// The shadow ray to the light; `valid` is false where it would start into the
/// surface or where no point of the light is seen. `view_distance` is what offset_origin wants.
Ray light_ray(Light light, SurfaceMaterial m, vec3 position, float view_distance, vec2 u,
              float pick, out bool valid) {
  LightSample s;
  if (has_area(light)) {
    s = sample_lit_point(light, m, position, u, pick, valid);
  } else {
    s = sample_light(light, position, u);
    // The light's disk may reach below the horizon, where nothing of it is seen.
    valid = dot(s.ray_direction, lit_side(m, s.direction)) > 0.0;
  }
  Ray ray;
  ray.origin = offset_origin(position, lit_side(m, s.direction), view_distance);
  ray.t_min = 0.0;
  ray.direction = s.ray_direction;
  // Geometry may lie where an area light does and show it: it must not occlude itself.
  ray.t_max = s.distance * 0.999;
  ray.pixel = ray.user = ray.padding0 = ray.padding1 = 0u;
  return ray;
}

#endif
