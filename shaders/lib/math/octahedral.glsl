// Unit vectors in two numbers, each in [-1, 1] (Cigolle et al. 2014, "oct").
#ifndef HELIOGRAPH_OCTAHEDRAL_GLSL
#define HELIOGRAPH_OCTAHEDRAL_GLSL

vec2 octahedral_encode(vec3 direction) {
  vec2 p = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return direction.z >= 0.0 ? p : folded;
}

/// Of any length; `p` in [-side, side]. What lies below folds back, away from p's signs.
vec3 octahedral_direction(vec2 p, float side) {
  float z = side - abs(p.x) - abs(p.y);
  uvec2 signs = floatBitsToUint(p) & 0x80000000u;
  vec2 fold = uintBitsToFloat(signs | floatBitsToUint(max(-z, 0.0)));
  return vec3(p - fold, z);
}

vec3 octahedral_decode(vec2 p) { return normalize(octahedral_direction(p, 1.0)); }

#endif
