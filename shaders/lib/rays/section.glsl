// What section planes leave of rays. The cut region's complement is convex, so that every ray keeps
// one interval.
#ifndef HELIOGRAPH_SECTION_GLSL
#define HELIOGRAPH_SECTION_GLSL
#include "shared/section.h"

layout(push_constant) uniform Constants { SectionConstants section; };

/// The interval of the ray that no plane cuts away: from x to y, empty where x >= y. `entered`: the
/// number of the plane at x, or -1 where no plane is.
vec2 kept_interval(vec3 origin, vec3 direction, out int entered) {
  vec2 kept = vec2(0.0, section_never);
  entered = -1;
  for (int i = 0; i < int(section.count); ++i) {
    float above = dot(section.planes[i].xyz, origin) - section.planes[i].w;
    float rise = dot(section.planes[i].xyz, direction);
    if (rise < 0.0) {
      float at = above / -rise;
      if (at > kept.x) {
        kept.x = at;
        entered = i;
      }
    } else if (rise > 0.0) {
      kept.y = min(kept.y, -above / rise);
    } else if (above > 0.0) {
      kept.y = -section_never;
    }
  }
  return kept;
}

#endif
