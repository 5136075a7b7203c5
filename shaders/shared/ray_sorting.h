// What host and shaders agree on about sorting ray streams: std430.
#ifndef HELIOGRAPH_SHARED_RAY_SORTING_H
#define HELIOGRAPH_SHARED_RAY_SORTING_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint ray_keys = 4096u;  // values of the key (lib/rays/ray_key.glsl)

// Where origins may lie: key = (origin - corner) x scale, 0..1.
struct RaySortConstants {
  vec4 corner;  // world, metres
  vec4 scale;
};

SHARED_END
#endif
