// Planes that cut a scene open.
#ifndef HELIOGRAPH_SHARED_SECTION_H
#define HELIOGRAPH_SHARED_SECTION_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint most_section_planes = 6u;
// Metres: beyond all coordinates, and what adds to it is finite.
SHARED_CONSTANT float section_never = 1e15;

// Push constants of the passes of sections.
struct SectionConstants {
  vec4 planes[6];  // unit normal, offset in metres: points with dot(normal, point) > offset are cut
  vec3 cap_color;  // linear
  uint count;      // of the planes
};

SHARED_END
#endif
