#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Gives the path traced radiance of pixels that show a cap its flat colour.
#include "lib/frame.glsl"
#include "lib/rays/section.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Caps { uvec2 caps[]; };
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2D radiance;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  if (caps[uint(pixel.y) * frame.extent.x + uint(pixel.x)].x == 0u) return;
  imageStore(radiance, pixel, vec4(section.cap_color, 1.0));
}
