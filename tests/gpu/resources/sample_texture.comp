#version 460
#extension GL_GOOGLE_include_directive : require
#include "tests/shader/harness.glsl"
#include "lib/scene/texture_heap.glsl"

ShaderOutput evaluate(uint which, ShaderInput given) {
  return ShaderOutput(sample_texture(which, given.a.xy, given.a.z), vec4(0.0));
}
