#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/frame.glsl"
#include "lib/denoise/frame_blending.glsl"
layout(local_size_x = 1) in;
// Empties a ray stream.
layout(set = 1, binding = 0, std430) writeonly buffer Count { RayCount ray_count; };
layout(push_constant) uniform Constants { uint stochastic; };  // 0: blended surfaces stop every ray

void main() {
  ray_count = RayCount(0u, 0u, 1u, 1u, stochastic != 0u ? frame_blending() : 0u, 0u, 1u, 1u);
}
