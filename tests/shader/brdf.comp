#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/lighting/brdf.glsl"
#include "lib/math/tone_map.glsl"

ShaderOutput evaluate(uint which, ShaderInput given) {
  switch (which) {
    case 0: return ShaderOutput(vec4(ggx_distribution(given.a.x, given.a.y)), vec4(0.0));
    case 1: return ShaderOutput(vec4(smith_visibility(given.a.x, given.a.y, given.a.z)), vec4(0.0));
    case 2: return ShaderOutput(vec4(mix(given.a.xyz, vec3(1.0), schlick_weight(given.a.w)), 0.0),
                                vec4(0.0));
    case 3: {
      // a: colour, metallic; b: view, roughness; c: light; d: split sum; the normal is +z.
      vec3 n = vec3(0.0, 0.0, 1.0);
      SurfaceMaterial m =
          make_material(given.a.rgb, given.a.w, given.b.w, n, n, given.b.xyz, given.d.xy,
                        plain_layer());
      return ShaderOutput(vec4(shade_light(m, given.c.xyz), 0.0),
                          vec4(specular_light(m, given.c.xyz), 0.0));
    }
    case 4: return ShaderOutput(vec4(tone_map_neutral(given.a.rgb), 0.0), vec4(0.0));
    case 5: return ShaderOutput(vec4(tone_map_aces(given.a.rgb), 0.0), vec4(0.0));
    case 6: return ShaderOutput(vec4(tone_map_agx(given.a.rgb), 0.0), vec4(0.0));
    default: return ShaderOutput(vec4(srgb_encode(given.a.rgb), 0.0), vec4(0.0));
  }
}
