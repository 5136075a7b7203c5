// Unit vectors in two numbers, each in [-1, 1] (Cigolle et al. 2014, "oct").
#ifndef HELIOGRAPH_OCTAHEDRAL_GLSL
#define HELIOGRAPH_OCTAHEDRAL_GLSL

vec2 octahedral_encode(vec3 direction) {
  vec2 p = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return direction.z >= 0.0 ? p : folded;
}

vec3 octahedral_decode(vec2 p) {
  vec3 direction = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float below = max(-direction.z, 0.0);
  direction.x += direction.x >= 0.0 ? -below : below;
  direction.y += direction.y >= 0.0 ? -below : below;
  return normalize(direction);
}

#endif
