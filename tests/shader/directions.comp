#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/math/equirectangular.glsl"
#include "lib/math/octahedral.glsl"

ShaderOutput evaluate(uint which, ShaderInput given) {
  switch (which) {
    case 0: {
      vec2 encoded = octahedral_encode(given.a.xyz);
      return ShaderOutput(vec4(encoded, 0.0, 0.0), vec4(octahedral_decode(encoded), 0.0));
    }
    case 1: {
      vec3 tangent, bitangent;
      orthonormal_basis(given.a.xyz, tangent, bitangent);
      return ShaderOutput(vec4(tangent, 0.0), vec4(bitangent, 0.0));
    }
    case 2: return ShaderOutput(vec4(offset_origin(given.a.xyz, given.b.xyz, given.b.w), 0.0), vec4(0.0));
    case 3: return ShaderOutput(vec4(sample_cosine(given.a.xyz, given.b.xy), 0.0), vec4(0.0));
    case 4: return ShaderOutput(vec4(sample_disk(given.a.xy), 0.0, 0.0), vec4(0.0));
    case 5: return ShaderOutput(vec4(equirectangular_uv(given.a.xyz), 0.0, 0.0), vec4(0.0));
    default: return ShaderOutput(vec4(cube_direction(ivec3(given.a.xyz), given.a.w), 0.0), vec4(0.0));
  }
}
