// Where a line of sight meets the plane that catches shadows. Include after declaring
// `float ground_shade[]`: for each texel the part of its light that arrives.
#ifndef HELIOGRAPH_GROUND_GLSL
#define HELIOGRAPH_GROUND_GLSL
#include "lib/frame.glsl"
#include "shared/ground.h"

float ground_texel(ivec2 texel) {
  ivec2 inside = clamp(texel, ivec2(0), ivec2(ground_side) - 1);
  return ground_shade[uint(inside.y) * ground_side + uint(inside.x)];
}

/// The factor of the background behind it: 1 where the line does not meet the ground from above.
float ground_factor(vec3 origin, vec3 direction) {
  vec4 ground = frame.ground;
  if (ground.w <= 0.0 || direction.y >= 0.0 || origin.y <= ground.y) return 1.0;
  float t = (ground.y - origin.y) / direction.y;
  vec2 at = (origin.xz + t * direction.xz - ground.xz) / ground.w;
  float from_middle = length(at);
  if (from_middle >= 1.0) return 1.0;
  vec2 texel = (0.5 * at + 0.5) * float(ground_side) - 0.5;
  ivec2 first = ivec2(floor(texel));
  vec2 between = texel - vec2(first);
  float above = mix(ground_texel(first), ground_texel(first + ivec2(1, 0)), between.x);
  float below = mix(ground_texel(first + ivec2(0, 1)), ground_texel(first + ivec2(1)), between.x);
  float shade = mix(above, below, between.y);
  return mix(shade, 1.0, smoothstep(ground_fade_start, 1.0, from_middle));
}

#endif
