#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Blends surfaces over the composed frame.
#include "lib/frame.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D radiance;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D mirrored;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D behind;
layout(set = 1, binding = 3, rgba32f) uniform image2D hdr;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec3 seen = imageLoad(behind, pixel).rgb;
  if (seen == vec3(1.0)) return;
  vec3 over = imageLoad(radiance, pixel).rgb + imageLoad(mirrored, pixel).rgb;
  // One bad pixel must not spread through the history.
  if (any(isnan(over)) || any(isinf(over))) over = vec3(0.0);
  vec4 picture = imageLoad(hdr, pixel);
  imageStore(hdr, pixel, vec4(picture.rgb * seen + over, picture.a));
}
