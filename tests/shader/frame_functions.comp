#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/environment.glsl"
#include "lib/lights.glsl"

ShaderOutput evaluate(uint which, ShaderInput given) {
  switch (which) {
    case 0: return ShaderOutput(vec4(environment_irradiance(given.a.xyz), 0.0), vec4(0.0));
    case 1: return ShaderOutput(vec4(environment_radiance(given.a.xyz), 0.0), vec4(0.0));
    case 2: return ShaderOutput(vec4(environment_reflection(given.a.xyz, given.a.w), 0.0), vec4(0.0));
    case 3: {
      // a: which light; b: position.
      LightSample s = light_at(lights[uint(given.a.x)], given.b.xyz);
      return ShaderOutput(vec4(s.direction, s.distance), vec4(s.irradiance, 0.0));
    }
    default: {
      // a: pixel, view Z.
      ivec2 pixel = ivec2(given.a.xy);
      return ShaderOutput(vec4(world_position(pixel, given.a.z), 0.0), vec4(to_eye(pixel), 0.0));
    }
  }
}
