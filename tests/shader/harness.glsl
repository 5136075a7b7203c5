// Calls `evaluate` once per input. Include first; then define
// ShaderOutput evaluate(uint function, ShaderInput given).
#ifndef HELIOGRAPH_HARNESS_GLSL
#define HELIOGRAPH_HARNESS_GLSL

layout(local_size_x = 64) in;

struct ShaderInput {
  vec4 a, b, c, d;
};
struct ShaderOutput {
  vec4 x, y;
};

layout(set = 1, binding = 0, std430) readonly buffer Inputs { ShaderInput inputs[]; };
layout(set = 1, binding = 1, std430) writeonly buffer Outputs { ShaderOutput outputs[]; };
layout(push_constant) uniform Constants { uint count; uint function; };

ShaderOutput evaluate(uint which, ShaderInput given);

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index < count) outputs[index] = evaluate(function, inputs[index]);
}

#endif
