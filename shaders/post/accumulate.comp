#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The running mean of a static view: mean' = mean + (sample - mean) / N; in w the variance of the
// samples' luminance (Welford 1962).
#include "lib/frame.glsl"
#include "lib/lighting/lights.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D hdr;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D previous;
layout(set = 1, binding = 2, rgba32f) writeonly uniform image2D accumulated;
layout(push_constant) uniform Constants { float weight; };  // 1 / N; 1 starts again

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec3 color = imageLoad(hdr, pixel).rgb;
  float variance = 0.0;
  if (weight < 1.0) {
    vec4 mean = imageLoad(previous, pixel);
    float light = luminance(color), before = luminance(mean.rgb);
    color = mix(mean.rgb, color, weight);
    variance = mix(mean.a, (light - before) * (light - luminance(color)), weight);
  }
  imageStore(accumulated, pixel, vec4(color, variance));
}
