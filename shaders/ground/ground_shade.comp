#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Darkens the background by the shadows on the ground in front of it.
#include "lib/frame.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 1, std430) readonly buffer Shade { float ground_shade[]; };
layout(set = 1, binding = 2, rgba32f) uniform image2D background;
#include "lib/lighting/ground.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel) || imageLoad(motion, pixel).w > 0.0) return;
  float factor = ground_factor(world_position(pixel, 0.0), -to_eye(pixel));
  if (factor < 1.0) imageStore(background, pixel, imageLoad(background, pixel) * vec4(vec3(factor), 1.0));
}
