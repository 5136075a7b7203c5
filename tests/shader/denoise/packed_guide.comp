#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/denoise/packed_guide.glsl"

ShaderOutput evaluate(uint which, ShaderInput given) {
  switch (which) {
    case 0: {
      // a: normal, roughness; b: view Z.
      uvec2 texel = pack_guide(Guide(given.a.xyz, given.a.w, given.b.x));
      Guide guide = unpack_guide(texel);
      return ShaderOutput(vec4(guide.normal, guide.roughness),
                          vec4(guide.view_z, is_background(texel), is_background(packed_background),
                               0.0));
    }
    case 1: {
      // a: slope, view Z.
      vec4 texel = pack_slope(given.a.xy, given.a.z);
      return ShaderOutput(vec4(unpack_slope(texel, given.a.z), 0.0, 0.0), texel);
    }
    default: return ShaderOutput(nearest_halves(given.a), vec4(0.0));
  }
}
