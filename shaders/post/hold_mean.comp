#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Blends the filtered mean of a static view into the frame that temporal antialiasing keeps: what is
// shown while path traced samples take the place of the hybrid's.
#include "lib/denoise/history_texels.glsl"
#include "lib/frame.glsl"

layout(set = 1, binding = 0, rgba16f) readonly uniform image2D mean;
layout(set = 1, binding = 1, r32f) readonly uniform image2D mean_weight;  // of `mean`
layout(set = 1, binding = 2, rgba16f) uniform image2D resolved;
layout(push_constant) uniform Constants {
  uvec2 shown;           // size of all images, pixels
  float uniform_weight;  // of `mean` in all pixels; below 0: that of `mean_weight`
};

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(pixel), shown))) return;
  vec4 color = imageLoad(resolved, pixel);
  float weight = uniform_weight < 0.0 ? imageLoad(mean_weight, pixel).r : uniform_weight;
  color.rgb = mix(color.rgb, imageLoad(mean, pixel).rgb, weight);
  imageStore(resolved, pixel, nearest_halves(color));
}
