#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The inverse of Reinhard's curve, or the paper's own (section 3.4).
#include "lib/frame.glsl"
#include "lib/denoise/reinhard.glsl"

layout(set = 1, binding = 0) uniform sampler2D compressed;
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2D radiance;
layout(push_constant) uniform Constants {
  float multiplier;
  float paper_weight;
  uint exact;
};

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec4 given = texelFetch(compressed, pixel, 0);
  vec3 color = exact != 0u ? inverse_reinhard(given.rgb, multiplier)
                           : paper_inverse_reinhard(given.rgb, paper_weight);
  imageStore(radiance, pixel, vec4(color, given.w));
}
