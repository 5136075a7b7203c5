// Rectangles and disks that shine on one side.
#ifndef HELIOGRAPH_AREA_LIGHTS_GLSL
#define HELIOGRAPH_AREA_LIGHTS_GLSL
#include "lib/frame.glsl"
#include "lib/lighting/ltc.glsl"

const int disk_corners = 16;  // of the polygon that stands for a disk

struct AreaSample {
  vec3 direction;     // unit length
  float distance;     // metres
  float solid_angle;  // 1 / density over solid angle; 0 behind the light
};

vec3 area_bitangent(Light light) { return cross(light.direction, light.tangent); }

/// Fractions of the diffuse (x) and the specular (y) lobe that the light covers, unshadowed.
vec2 area_light_shares(Light light, vec3 normal, vec3 eye, float n_dot_v, float roughness,
                       vec3 position) {
  vec3 middle = light.position - position;
  if (dot(middle, light.direction) >= 0.0) return vec2(0.0);
  mat3 to_frame = shading_frame(normal, eye);
  mat3 inverse_lobe = ltc_inverse(ltc_table, n_dot_v, roughness);
  bool disk = light.type == light_disk;
  int corners = disk ? disk_corners : 4;
  float step_angle = 2.0 * pi / float(corners);
  // Corners run around a circle; a rectangle's, squeezed, begin at a diagonal. A disk's polygon has
  // the disk's area.
  float size = disk ? light.radius * sqrt(step_angle / sin(step_angle)) : sqrt(2.0);
  vec3 along = to_frame * light.tangent * (disk ? size : size * light.half_width);
  vec3 across = to_frame * area_bitangent(light) * (disk ? size : size * light.half_height);
  middle = to_frame * middle;
  vec2 turn = vec2(cos(step_angle), sin(step_angle));
  vec2 at = vec2(sqrt(0.5));
  vec3 before = middle + at.x * along + at.y * across;
  vec3 moved_before = inverse_lobe * before;
  Contour diffuse = empty_contour();
  Contour specular = empty_contour();
  for (int i = 0; i < corners; ++i) {
    at = vec2(at.x * turn.x - at.y * turn.y, at.x * turn.y + at.y * turn.x);
    vec3 corner = middle + at.x * along + at.y * across;
    vec3 moved = inverse_lobe * corner;
    add_edge(diffuse, before, corner);
    add_edge(specular, moved_before, moved);
    before = corner;
    moved_before = moved;
  }
  float above = ltc_share_above(inverse_lobe);
  return vec2(covered_cosine(diffuse), min(covered_cosine(specular) / above, 1.0));
}

AreaSample sample_of_point(Light light, vec3 offset, float area) {
  AreaSample s;
  float squared = max(dot(offset, offset), 1e-12);
  s.distance = sqrt(squared);
  s.direction = offset / s.distance;
  s.solid_angle = area * max(-dot(light.direction, s.direction), 0.0) / squared;
  return s;
}

/// A point of a rectangle, uniform over the solid angle it is seen under (Urena, Fajardo and King,
/// "An Area-Preserving Parametrization for Spherical Rectangles", 2013). Small or distant ones,
/// whose angles cancel in single precision, by their area.
AreaSample sample_rectangle(Light light, vec3 position, vec2 u) {
  vec3 bitangent = area_bitangent(light);
  vec3 middle = light.position - position;
  float area = 4.0 * light.half_width * light.half_height;
  float height = dot(middle, light.direction);
  if (height >= 0.0) return AreaSample(-light.direction, 1.0, 0.0);
  if (area < 0.02 * dot(middle, middle)) {
    vec2 at = (2.0 * u - 1.0) * vec2(light.half_width, light.half_height);
    return sample_of_point(light, middle + light.tangent * at.x + bitangent * at.y, area);
  }
  // Seen from `position`: x along the tangent, y along the bitangent, z toward the surface.
  vec2 center = vec2(dot(middle, light.tangent), dot(middle, bitangent));
  vec2 low = center - vec2(light.half_width, light.half_height);
  vec2 high = center + vec2(light.half_width, light.half_height);
  // The planes through the eye and each side: their angles are the corners of the spherical
  // rectangle, whose excess is its area (Girard).
  vec2 bottom = normalize(vec2(height, -low.y));   // y, z of the normals
  vec2 top = normalize(vec2(-height, high.y));
  vec2 right = normalize(vec2(-height, high.x));   // x, z
  vec2 left = normalize(vec2(height, -low.x));
  float angle0 = acos(clamp(-bottom.y * right.y, -1.0, 1.0));
  float angle1 = acos(clamp(-right.y * top.y, -1.0, 1.0));
  float angle2 = acos(clamp(-top.y * left.y, -1.0, 1.0));
  float angle3 = acos(clamp(-left.y * bottom.y, -1.0, 1.0));
  float rest = 2.0 * pi - angle2 - angle3;
  float solid_angle = max(angle0 + angle1 - rest, 0.0);
  float around = u.x * solid_angle + rest;
  float f = (cos(around) * bottom.y - top.y) / sin(around);
  float cosine = (f > 0.0 ? 1.0 : -1.0) / max(sqrt(f * f + bottom.y * bottom.y), 1.0);
  float x = -cosine * height / sqrt(max(1.0 - cosine * cosine, 1e-12));
  x = clamp(x, low.x, high.x);
  float squared = x * x + height * height;
  float h0 = low.y / sqrt(squared + low.y * low.y);
  float h1 = high.y / sqrt(squared + high.y * high.y);
  float h = mix(h0, h1, u.y);
  float y = h * h < 1.0 - 1e-6 ? h * sqrt(squared / (1.0 - h * h)) : high.y;
  vec3 offset = light.tangent * x + bitangent * y + light.direction * height;
  float distance = length(offset);
  return AreaSample(offset / distance, distance, solid_angle);
}

AreaSample sample_area(Light light, vec3 position, vec2 u) {
  if (light.type == light_rectangle) return sample_rectangle(light, position, u);
  vec2 at = sample_disk(u) * light.radius;
  vec3 offset = light.position - position + light.tangent * at.x + area_bitangent(light) * at.y;
  return sample_of_point(light, offset, pi * light.radius * light.radius);
}

#endif
