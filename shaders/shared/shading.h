// Ways to show surfaces other than as they are lit: what the shader and the host kernel share.
#ifndef HELIOGRAPH_SHARED_SHADING_H
#define HELIOGRAPH_SHARED_SHADING_H
#include "types.h"
SHARED_BEGIN

// protocol::ShadingMode
SHARED_CONSTANT uint shading_wireframe = 1u;
SHARED_CONSTANT uint shading_clay = 2u;
SHARED_CONSTANT uint shading_matcap = 3u;
SHARED_CONSTANT uint shading_uv_checker = 4u;
SHARED_CONSTANT uint shading_normals = 5u;

SHARED_CONSTANT float clay_albedo = 0.5f;
SHARED_CONSTANT float clay_roughness = 0.9f;
// Lines are black, or this bright on surfaces darker than `dark_surface`.
SHARED_CONSTANT float bright_line = 0.8f;
SHARED_CONSTANT float dark_surface = 0.02f;

struct ShadingConstants {
  uint mode;  // shading_*
};

/// What of a number is positive.
SHARED_FUNCTION float positive_part(float value) {
  return value > 0.0f ? value : 0.0f;
}

/// Linear colour of a grey ball in a studio at the normal `n`: x right, y up, z toward the eye.
SHARED_FUNCTION vec3 matcap_color(vec3 n) {
  float key = positive_part(dot(n, vec3(-0.492f, 0.640f, 0.590f)));
  float fill = positive_part(dot(n, vec3(0.758f, -0.379f, 0.531f)));
  float gloss = positive_part(dot(n, vec3(-0.276f, 0.359f, 0.892f)));
  float rim = 1.0f - positive_part(n.z);
  gloss = gloss * gloss * gloss * gloss;
  gloss = gloss * gloss * gloss * gloss;
  rim = rim * rim * rim * rim;
  return vec3(0.035f, 0.038f, 0.045f) + vec3(0.52f, 0.49f, 0.45f) * key +
         vec3(0.07f, 0.09f, 0.14f) * fill + vec3(0.22f) * (gloss * gloss) +
         vec3(0.10f, 0.12f, 0.16f) * rim;
}

/// Linear colour of a checkerboard of 8 x 8 fields for each unit of texture coordinates: red grows
/// with u, green with v, and a light line borders each unit.
SHARED_FUNCTION vec3 uv_checker_color(vec2 uv) {
  vec2 within = fract(uv);
  vec2 field = floor(within * 8.0f);
  bool is_odd = fract(vec2(field.x + field.y) * 0.5f).x > 0.25f;
  vec2 to_border = vec2(0.5f) - abs(within - vec2(0.5f));
  float border = 0.008f;
  if (to_border.x < border || to_border.y < border) return vec3(0.9f);
  vec3 color = vec3(0.08f + 0.72f * within.x, 0.08f + 0.72f * within.y, 0.35f);
  return color * (is_odd ? 1.0f : 0.4f);
}

/// The distance from the origin to the line through `a` and `b`, both in a plane through it.
SHARED_FUNCTION float line_distance(vec3 a, vec3 b) {
  float size = length(b - a);
  return size > 0.0f ? length(cross(a, b)) / size : 0.0f;
}

/// Whether an edge of a triangle covers a point of it. Corners are relative to the point, in
/// metres, and seen along the unit vector `direction`; a pixel there is `pixel` metres wide. Edges
/// of small triangles are thinner, so that some of the surface is left between them.
SHARED_FUNCTION bool is_on_edge(vec3 a, vec3 b, vec3 c, vec3 direction, float pixel) {
  a -= direction * dot(a, direction);
  b -= direction * dot(b, direction);
  c -= direction * dot(c, direction);
  float sides = length(b - a) + length(c - b) + length(a - c);
  float inner_radius = length(cross(b - a, c - a)) / (sides > 0.0f ? sides : 1.0f);
  float half_width = 0.6f * pixel;
  if (half_width > 0.3f * inner_radius) half_width = 0.3f * inner_radius;
  return line_distance(a, b) < half_width || line_distance(b, c) < half_width ||
         line_distance(c, a) < half_width;
}

SHARED_END
#endif
