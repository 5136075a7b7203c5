#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/lighting/environment_sampling.glsl"

ShaderOutput evaluate(uint which, ShaderInput given) {
  if (which == 1u) {
    vec3 radiance = environment_radiance(given.a.xyz);
    return ShaderOutput(vec4(environment_density(given.a.xyz)), vec4(radiance, 0.0));
  }
  EnvironmentSample s = sample_environment(given.a.xy, given.a.zw);
  return ShaderOutput(vec4(s.direction, s.density), vec4(environment_radiance(s.direction), 0.0));
}
