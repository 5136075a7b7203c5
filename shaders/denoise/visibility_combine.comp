#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Shadow and ambient visibility side by side, so that one filter serves both.
#include "lib/frame.glsl"
#include "lib/denoise/moments.glsl"

layout(set = 1, binding = 0, r32f) readonly uniform image2D shadow_visibility;
layout(set = 1, binding = 1, r32f) readonly uniform image2D ambient_visibility;
layout(set = 1, binding = 2, rg16f) writeonly uniform image2D visibility;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  imageStore(visibility, pixel, vec4(sanitize(imageLoad(shadow_visibility, pixel).r),
                                     sanitize(imageLoad(ambient_visibility, pixel).r), 0.0, 0.0));
}
