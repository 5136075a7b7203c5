#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Blurs the denoised frame by the lens, and the noisy one alike.
#include "lib/frame.glsl"

layout(set = 1, binding = 2, rgba32f) readonly uniform image2D hdr;
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D noisy;
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D blurred;
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D blurred_noisy;

mat2x4 light_at(ivec2 pixel) { return mat2x4(imageLoad(hdr, pixel), imageLoad(noisy, pixel)); }

#include "lib/lens/defocus_gather.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  mat2x4 shown = through_lens(pixel);
  imageStore(blurred, pixel, shown[0]);
  imageStore(blurred_noisy, pixel, shown[1]);
}
