// Rays and hits as they travel between generation, tracing and shading: std430.
#ifndef HELIOGRAPH_SHARED_RAY_H
#define HELIOGRAPH_SHARED_RAY_H
#include "types.h"
SHARED_BEGIN

// World space. `pixel` is x | y << 16 of the pixel that asked; tracers leave it alone.
struct Ray {
  vec3 origin;
  float t_min;
  vec3 direction;  // unit length
  float t_max;
  uint pixel;
  uint user;  // whatever the generating pass wants back when shading
  uint padding0;
  uint padding1;
};

SHARED_CONSTANT uint hit_none = 0xffffffffu;

// Closest hits. Barycentric (u, v) weigh the second and third vertex. instance == hit_none: a miss.
struct Hit {
  float t;
  uint instance;
  uint triangle;  // within the instance's mesh
  float u;
  float v;
  uint padding0;
  uint padding1;
  uint padding2;
};

// In front of a ray stream: how many rays there are, and the indirect dispatch that covers them.
struct RayCount {
  uint count;
  uint groups_x;  // VkDispatchIndirectCommand
  uint groups_y;
  uint groups_z;
};

SHARED_END
#endif
