#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Composes the frame from this frame's noisy signals.
#include "lib/lighting/composition.glsl"

layout(set = 1, binding = 11, rgba32f) writeonly uniform image2D hdr;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  imageStore(hdr, pixel, composed_of_raw_signals(pixel_composition(pixel), pixel, vec3(0.0)));
}
