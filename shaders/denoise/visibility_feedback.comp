#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Makes the result of one of the blur's iterations the history of the next frame (SVGF, section
// 4.3).
#include "lib/frame.glsl"
#include "lib/denoise/history_texels.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D filtered;
layout(set = 1, binding = 1, rgba16) writeonly uniform image2D kept;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  uvec4 rounding = rounding_of(pixel, frame.sample_index);
  imageStore(kept, pixel, as_fractions(imageLoad(filtered, pixel), rounding));
}
