#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/lighting/lights.glsl"

// a: position of the light, type; b: its direction, half its width or radius; c: its tangent, half
// its height; d: eye and roughness, or random numbers. The surface is the origin, facing +z.
ShaderOutput evaluate(uint which, ShaderInput given) {
  Light light;
  light.position = given.a.xyz;
  light.type = uint(given.a.w);
  light.direction = given.b.xyz;
  light.range = 0.0;
  light.color = vec3(1.0);
  light.radius = light.half_width = given.b.w;
  light.tangent = given.c.xyz;
  light.half_height = given.c.w;
  if (which == 0u) {
    vec2 shares = area_light_shares(light, vec3(0.0, 0.0, 1.0), given.d.xyz, max(given.d.z, 1e-3),
                                    given.d.w, vec3(0.0));
    return ShaderOutput(vec4(shares, 0.0, 0.0), vec4(0.0));
  }
  LightSample s = sample_light(light, vec3(0.0), given.d.xy);
  return ShaderOutput(vec4(s.direction, s.distance), vec4(s.irradiance, 0.0));
}
