// Which surfaces a camera's ray ends on, in every pass that traces it: the G-buffer from rays and
// the reference path tracer see the same ones as drawn triangles.
#ifndef HELIOGRAPH_COVERAGE_GLSL
#define HELIOGRAPH_COVERAGE_GLSL
#include "lib/scene/hit_surface.glsl"

/// Whether the camera sees nothing there: the back of a face that is not drawn, or a hole. Tracers
/// test the nearest texel of a mask; the frame shows the filtered one.
bool is_open(HitSurface s, vec3 direction) {
  if (dot(s.front, direction) > 0.0 && (s.flags & material_double_sided) == 0u) return true;
  return (s.flags & material_alpha_mask) != 0u && s.alpha < s.alpha_cutoff;
}

/// The same for what needs no more of a surface. `width`: of the ray's footprint there, metres.
bool is_open(Hit hit, vec3 direction, float width) {
  HitTriangle t = load_triangle(hit);
  const uint flags = materials[t.material].flags;
  vec3 across = triangle_across(t);
  float twice_world_area = length(across);
  float cosine = dot(front_normal(across, twice_world_area, interpolated_normal(t)), direction);
  if (cosine > 0.0 && (flags & material_double_sided) == 0u) return true;
  if ((flags & material_alpha_mask) == 0u || (flags & material_whole_alpha) != 0u) return false;
  TextureLookup lookup = texture_lookup(t, twice_world_area, width, abs(cosine));
  return triangle_color(t, lookup).a < materials[t.material].alpha_cutoff;
}

/// Whether something of what is behind shows through the surface.
bool is_blended(HitSurface s) {
  return (s.flags & material_alpha_blend) != 0u &&
         s.alpha * (1.0 - s.layer.transmission) < least_solid;
}

/// The rest of the ray behind what it has met.
Ray beyond(Ray ray, Hit hit) {
  ray.t_min = hit.t + max(hit.t * 1e-6, 1e-7);
  return ray;
}

#endif
