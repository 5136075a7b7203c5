#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/math/sampling.glsl"

// a: view, alpha; b: two random numbers, or the direction of light; alpha along y, 0: the same.
ShaderOutput evaluate(uint which, ShaderInput given) {
  vec3 view = given.a.xyz;
  vec2 alpha = vec2(given.a.w, given.b.w == 0.0 ? given.a.w : given.b.w);
  if (which == 0u) {
    vec3 normal = sample_visible_normal(view, alpha, given.b.xy);
    vec3 light = reflect(-view, normal);
    return ShaderOutput(vec4(normal, visible_normal_weight(view, light, alpha)), vec4(light, 0.0));
  }
  return ShaderOutput(vec4(visible_normal_pdf(view, given.b.xyz, alpha),
                           visible_normal_weight(view, given.b.xyz, alpha), 0.0, 0.0), vec4(0.0));
}
