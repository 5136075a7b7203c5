#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Blurs the frame by the lens.
#include "lib/frame.glsl"

layout(set = 1, binding = 2, rgba32f) readonly uniform image2D hdr;
layout(set = 1, binding = 3, rgba32f) writeonly uniform image2D blurred;

mat2x4 light_at(ivec2 pixel) { return mat2x4(imageLoad(hdr, pixel), vec4(0.0)); }

#include "lib/lens/defocus_gather.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (!outside_frame(pixel)) imageStore(blurred, pixel, through_lens(pixel)[0]);
}
