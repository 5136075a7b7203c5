#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Which pixels show a cap: those whose ray enters the scene through a section plane and next meets
// the back of a face that has no back, so that it has begun inside a solid.
#include "lib/rays/ray_index.glsl"
#include "lib/rays/section.glsl"
#include "lib/scene/coverage.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer Hits { Hit hits[]; };
// By pixel: number of the plane + 1, instance + 1; 0: no cap.
layout(set = 1, binding = 3, std430) writeonly buffer Caps { uvec2 caps[]; };

bool ends_inside(Hit hit, vec3 direction) {
  HitTriangle t = load_triangle(hit);
  if ((materials[t.material].flags & (material_double_sided | material_alpha_blend)) != 0u) {
    return false;
  }
  vec3 front = cross(transform_direction(t, t.b.position - t.a.position),
                     transform_direction(t, t.c.position - t.a.position)) * t.handedness;
  return dot(front, direction) > 0.0;
}

void main() {
  uint index = ray_index();
  if (index >= ray_count.count) return;
  Ray ray = rays[index];
  ivec2 pixel = ivec2(ray.pixel & 0xffffu, ray.pixel >> 16u);
  if (outside_frame(pixel)) return;
  uvec2 cap = uvec2(0u);
  if (hits[index].instance != hit_none) {
    int entered;
    float from = kept_interval(ray.origin, ray.direction, entered).x;
    // A ray that begins behind the plane does not enter through it.
    bool enters = entered >= 0 && from >= ray.t_min * 0.999999;
    if (enters && ends_inside(hits[index], ray.direction)) {
      cap = uvec2(uint(entered) + 1u, hits[index].instance + 1u);
    }
  }
  caps[uint(pixel.y) * frame.extent.x + uint(pixel.x)] = cap;
}
