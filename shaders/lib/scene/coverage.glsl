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
