// Choosing one of the frame's points of emissive triangles for a diffuse receiver. A pass declares
// the buffer `points` before it includes this.
#ifndef HELIOGRAPH_EMISSIVE_CHOICE_GLSL
#define HELIOGRAPH_EMISSIVE_CHOICE_GLSL
#include "lib/lighting/emissive_balance.glsl"
#include "lib/lighting/light_choice.glsl"

struct EmissiveChoice {
  vec3 light;      // irradiance / pi, unshadowed, as one sample of all points
  float total;     // its luminance; 0: there is none
  vec3 direction;  // toward the point
  float distance;
};

/// One of some points, by what it sends (resampling; Talbot et al. 2005). `start` in [0, 1) says
/// which they are; `pick` decides. `near` and `behind`: factors on the light of either side of the
/// receiver; points behind need a factor that is not 0.
EmissiveChoice choose_emissive(vec3 position, vec3 normal, vec3 geometric, vec3 near, vec3 behind,
                               float start, float pick) {
  EmissiveChoice choice = EmissiveChoice(vec3(0.0), 0.0, normal, 0.0);
  float weight = 0.0;
  for (uint i = 0u; i < emissive_candidates; ++i) {
    uint index = uint(start * float(emissive_points)) + i * (emissive_points / emissive_candidates);
    EmissivePoint point = points[index % emissive_points];
    vec3 way = point.position - position;
    float squared = max(dot(way, way), 1e-20);
    vec3 direction = way * inversesqrt(squared);
    float there = -dot(point.normal, direction);
    if (point.both > 0.0) there = abs(there);
    float above = dot(geometric, direction);
    float here = dot(normal, direction) / pi;
    vec3 factor = near;
    if (above < 0.0 && behind != vec3(0.0)) {
      above = -above;
      here = -here;
      factor = behind;
    }
    if (point.density <= 0.0 || min(min(here, there), above) <= 0.0) continue;
    vec3 light = point.emission * emissive_share(point.density, here, there, squared) * factor;
    float sent = luminance(light);
    if (!takes(sent, choice.total, pick)) continue;
    weight = sent;
    choice.light = light;
    choice.direction = direction;
    choice.distance = sqrt(squared);
  }
  if (choice.total > 0.0) choice.light *= choice.total / weight;
  return choice;
}

/// Of a receiver that gets light from one side only.
EmissiveChoice choose_emissive(vec3 position, vec3 normal, vec3 geometric, float start,
                               float pick) {
  return choose_emissive(position, normal, geometric, vec3(1.0), vec3(0.0), start, pick);
}

#endif
