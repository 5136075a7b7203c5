#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/lighting/emissive_lights.glsl"

/// Draws by a; b.xyz is the receiver. Function 1: how likely a ray from there finds the point.
ShaderOutput evaluate(uint which, ShaderInput given) {
  Hit drawn = draw_emissive(given.a.xy, given.a.zw);
  EmissiveSample s = emissive_sample(drawn, given.b.xyz, RayCone(0.0, 0.0));
  if (which == 0u) return ShaderOutput(vec4(s.position, s.density), vec4(s.emission, drawn.instance));
  vec3 way = s.position - given.b.xyz;
  drawn.t = length(way);
  vec3 direction = way / drawn.t;
  HitSurface met = hit_surface(drawn, direction, 0.0);
  float sampled = density_of_direction(s.density, drawn.t, dot(s.normal, direction));
  float shines = side_shines(met, direction) ? 1.0 : 0.0;
  return ShaderOutput(vec4(sampled, emissive_density(drawn, met, direction), s.emission.g,
                           met.emissive.g * shines),
                      vec4(met.position - s.position, distance(met.front, s.normal)));
}
