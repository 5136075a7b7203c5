#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Shadow and ambient visibility each in its own image, as composition reads them.
#include "lib/frame.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D visibility;
layout(set = 1, binding = 1, r32f) writeonly uniform image2D shadow_visibility;
layout(set = 1, binding = 2, r32f) writeonly uniform image2D ambient_visibility;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec4 both = imageLoad(visibility, pixel);
  imageStore(shadow_visibility, pixel, vec4(both.x));
  imageStore(ambient_visibility, pixel, vec4(both.y));
}
