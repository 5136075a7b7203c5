#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Composes the frame from denoised signals, and where it is needed from this frame's noisy ones.
#include "lib/lighting/composition.glsl"

layout(set = 1, binding = 11) uniform sampler2D denoised_visibility;
layout(set = 1, binding = 12) uniform sampler2D denoised_specular;
layout(set = 1, binding = 13) uniform sampler2D denoised_indirect;
layout(set = 1, binding = 14, rgba32f) writeonly uniform image2D hdr;
layout(set = 1, binding = 15, rgba32f) writeonly uniform image2D hdr_raw;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  Composition shares = pixel_composition(pixel);
  vec2 visibility = texelFetch(denoised_visibility, pixel, 0).xy;
  vec3 mirrored = max_roughness < 0.0 ? vec3(0.0) : texelFetch(denoised_specular, pixel, 0).rgb;
  vec3 around = enabled(frame_indirect) ? texelFetch(denoised_indirect, pixel, 0).rgb : vec3(0.0);
  imageStore(hdr, pixel, composed(shares, visibility, mirrored, around));
  if (makes_noisy == 0u) return;
  imageStore(hdr_raw, pixel, composed_of_raw_signals(shares, pixel, around));
}
