// What camera rays meet first, where gbuffer_small.comp and gbuffer_large.comp draw. DRAWN_BINDING
// is the first of three bindings of the pass set: what was traced, what was drawn, and in which
// tiles which of them counts. BVH_BINDING as for bvh.glsl, whose triangles are met once more.
#ifndef HELIOGRAPH_DRAWN_HIT_GLSL
#define HELIOGRAPH_DRAWN_HIT_GLSL
#define ANY_HIT false
#include "lib/rays/bvh.glsl"
#include "lib/rays/drawn_key.glsl"
#include "shared/drawn.h"

layout(set = 1, binding = DRAWN_BINDING, std430) readonly buffer Traced { Hit traced[]; };
layout(set = 1, binding = DRAWN_BINDING + 1, std430) readonly buffer Nearest {
  uint64_t nearest[];
};
layout(set = 1, binding = DRAWN_BINDING + 2, std430) readonly buffer Found { uint found_by[]; };

/// `index`: gbuffer_ray_index() of the ray.
Hit drawn_hit(uint index, Ray ray) {
  const uint found = found_by[index / tile_pixels];
  if (found == tile_traced) return traced[index];
  Hit hit = no_hit(ray);
  const uint64_t key = nearest[index];
  if (found == tile_drawn_and_traced && key >= drawn_key(traced[index].t, 0u)) return traced[index];
  if (key == drawn_nothing) return hit;
  vec3 tuv;
  uvec3 words;
  const Line line = make_line(ray.origin, ray.direction);
  triangle_hit(drawn_slot(key), line, vec2(ray.t_min, ray.t_max), tuv, words);
  set_hit(tuv, words, hit);
  return hit;
}

#endif
