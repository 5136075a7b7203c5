#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Moves the origins of camera rays over the aperture of a thin lens. Each still meets the point in
// focus that it met before (Cook et al. 1984).
#include "lib/frame.glsl"
#include "lib/math/geometry.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/ray_index.glsl"
#include "shared/reference.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) buffer Rays { Ray rays[]; };

void main() {
  uint index = ray_index();
  if (index >= ray_count.count || frame.lens_radius <= 0.0) return;
  Ray ray = rays[index];
  if (ray.t_min >= ray.t_max) return;
  uvec2 pixel = uvec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
  vec2 u = random_pair(pixel, frame.sample_index, lens_dimension, frame.seed);
  vec2 at = sample_disk(u) * frame.lens_radius;
  vec3 forward = -frame.inverse_view[2].xyz;
  vec3 shift = at.x * frame.inverse_view[0].xyz + at.y * frame.inverse_view[1].xyz;
  vec3 in_focus = ray.direction * (frame.focus_distance / dot(ray.direction, forward));
  rays[index].origin = ray.origin + shift;
  rays[index].direction = normalize(in_focus - shift);
}
