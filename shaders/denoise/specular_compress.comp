#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Reinhard's curve over reflections before they are denoised (paper section 3.4).
#include "lib/frame.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/denoise/reinhard.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D radiance;  // w: hit distance
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2D compressed;
layout(push_constant) uniform Constants { float multiplier; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec4 given = imageLoad(radiance, pixel);
  imageStore(compressed, pixel, vec4(reinhard(sanitize(given.rgb), multiplier), given.w));
}
