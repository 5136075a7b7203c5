#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/lighting/environment.glsl"
#include "lib/lighting/lights.glsl"

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
    case 4: {
      // a: metallic, roughness, n.v; a white surface that faces +z.
      vec3 n = vec3(0.0, 0.0, 1.0);
      vec3 eye = vec3(sqrt(1.0 - given.a.z * given.a.z), 0.0, given.a.z);
      SurfaceMaterial m = surface_material(vec3(1.0), given.a.x, given.a.y, n, n, eye,
                                           plain_layer());
      return ShaderOutput(vec4(m.specular_albedo, 0.0), vec4(m.diffuse_albedo, 0.0));
    }
    default: {
      // a: pixel, view Z.
      ivec2 pixel = ivec2(given.a.xy);
      return ShaderOutput(vec4(world_position(pixel, given.a.z), 0.0), vec4(to_eye(pixel), 0.0));
    }
  }
}
