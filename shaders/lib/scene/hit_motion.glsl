// How what a ray has met moves, from the buffer `previous_vertices`, which the pass declares before it
// includes this.
#ifndef HELIOGRAPH_HIT_MOTION_GLSL
#define HELIOGRAPH_HIT_MOTION_GLSL
#include "lib/scene/hit_surface.glsl"

/// Where the point of the triangle was in its mesh one frame ago.
vec3 previous_local(Hit hit, HitSurface s) {
  if (!scene_has(scene_deforms)) return s.local;
  uint base = instances[hit.instance].previous_vertex;
  if (base == 0u) return s.local;
  uint first = meshes[instances[hit.instance].mesh].first_index + 3u * hit.triangle;
  vec3 a = previous_vertices[base - 1u + indices[first]].position;
  vec3 b = previous_vertices[base - 1u + indices[first + 1u]].position;
  vec3 c = previous_vertices[base - 1u + indices[first + 2u]].position;
  return a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
}

/// As the G-buffer has it.
vec4 motion_of(Hit hit, HitSurface s, float view_z) {
  mat3x4 before = mat3x4(transpose(instances[hit.instance].previous_world));
  vec4 previous = vec4(vec4(previous_local(hit, s), 1.0) * before, 1.0);
  vec3 clip_now = (frame.unjittered * vec4(s.position, 1.0)).xyw;
  vec3 clip_before = (frame.previous_unjittered * previous).xyw;
  float z_before = -(frame.previous_view * previous).z;
  return vec4(clip_before.xy / clip_before.z * 0.5 - clip_now.xy / clip_now.z * 0.5,
              z_before - view_z, view_z);
}

#endif
