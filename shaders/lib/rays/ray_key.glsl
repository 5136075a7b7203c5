// The sort key of rays: the octant of the direction, then the origin's cell in an 8x8x8 grid of
// the scene in Morton order.
#ifndef HELIOGRAPH_RAY_KEY_GLSL
#define HELIOGRAPH_RAY_KEY_GLSL
#include "shared/ray.h"
#include "shared/ray_sorting.h"

layout(push_constant) uniform Constants { RaySortConstants scene; };

uint every_third(uint v) { return (v & 1u) | (v & 2u) << 2u | (v & 4u) << 4u; }

uint ray_key(vec3 origin, vec3 direction) {
  uvec3 forward = uvec3(greaterThanEqual(direction, vec3(0.0)));
  uint octant = forward.x | forward.y << 1u | forward.z << 2u;
  vec3 grid_position = clamp((origin - scene.corner.xyz) * scene.scale.xyz, 0.0, 0.999);
  uvec3 cell = uvec3(grid_position * 8.0);
  return octant << 9u | every_third(cell.x) | every_third(cell.y) << 1u | every_third(cell.z) << 2u;
}

#endif
