#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/math/random.glsl"

// Whole numbers come as pairs of 16-bit halves, which floats hold exactly.
uint whole(vec2 halves) { return uint(halves.x) << 16u | uint(halves.y); }
vec2 halves(uint number) { return vec2(number >> 16u, number & 0xffffu); }

ShaderOutput evaluate(uint which, ShaderInput given) {
  uvec3 v = uvec3(whole(given.a.xy), whole(given.a.zw), whole(given.b.xy));
  if (which == 0u) {
    uvec3 hashed = pcg3d(v);
    return ShaderOutput(vec4(halves(hashed.x), halves(hashed.y)), vec4(halves(hashed.z), 0.0, 0.0));
  }
  uint dimension = uint(given.b.z);
  uint seed = uint(given.b.w);
  return ShaderOutput(vec4(random_pair(v.xy, v.z, dimension, seed),
                           random_number(v.xy, v.z, dimension, seed), 0.0), vec4(0.0));
}
