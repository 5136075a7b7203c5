// Where rays pass through masked meshes, for tracers whose hierarchies are the driver's: std430.
#ifndef HELIOGRAPH_SHARED_RAY_MASK_H
#define HELIOGRAPH_SHARED_RAY_MASK_H
#include "types.h"
SHARED_BEGIN

struct RayMask {
  uint texels;  // offset in bytes into the alpha heap
  uint width;
  uint height;
  uint threshold;  // lowest alpha, of 255, that stops a ray
  uint wrap_s;     // values of wrap_*
  uint wrap_t;
  uint first_uv;  // three per triangle
  uint padding0;
};

SHARED_END
#endif
