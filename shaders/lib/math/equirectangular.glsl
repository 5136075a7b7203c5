#ifndef HELIOGRAPH_EQUIRECTANGULAR_GLSL
#define HELIOGRAPH_EQUIRECTANGULAR_GLSL
#include "lib/math/geometry.glsl"

/// u = 0.5 + atan2(z, x) / 2 pi, v = acos(y) / pi.
vec2 equirectangular_uv(vec3 direction) {
  float u = direction.x == 0.0 && direction.z == 0.0 ? 0.0 : atan(direction.z, direction.x);
  return vec2(0.5 + u / (2.0 * pi), acos(clamp(direction.y, -1.0, 1.0)) / pi);
}

/// Direction through the middle of a cube face's texel, Vulkan's face order and axes.
vec3 cube_direction(ivec3 texel, float size) {
  vec2 p = (vec2(texel.xy) + 0.5) / size * 2.0 - 1.0;
  switch (texel.z) {
    case 0: return normalize(vec3(1.0, -p.y, -p.x));
    case 1: return normalize(vec3(-1.0, -p.y, p.x));
    case 2: return normalize(vec3(p.x, 1.0, p.y));
    case 3: return normalize(vec3(p.x, -1.0, -p.y));
    case 4: return normalize(vec3(p.x, -p.y, 1.0));
    default: return normalize(vec3(-p.x, -p.y, -1.0));
  }
}

#endif
