#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
// Histogram of log2 luminance over every second row and column of the frame as it will be shown.
// Whole numbers only: the order of addition does not show.
#include "lib/frame.glsl"
#include "lib/lighting/lights.glsl"
#include "shared/exposure.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D hdr;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D accumulated;
layout(set = 1, binding = 2, std430) buffer Histogram { uint bins[]; };
layout(push_constant) uniform Constants { float mean_share; };

shared uint group_bins[exposure_bins];

void main() {
  group_bins[gl_LocalInvocationIndex] = 0u;
  barrier();
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) * 2;
  if (!outside_frame(pixel)) {
    vec3 radiance = mean_share < 1.0 ? imageLoad(hdr, pixel).rgb : vec3(0.0);
    if (mean_share > 0.0) radiance = mix(radiance, imageLoad(accumulated, pixel).rgb, mean_share);
    float light = luminance(radiance);
    if (light > exp2(exposure_darkest)) {
      float bin = (log2(light) - exposure_darkest) * exposure_bins_per_stop;
      bin = min(bin, float(exposure_bins) - 1.001);
      uint upper = uint(fract(bin) * float(exposure_pixel_weight));
      atomicAdd(group_bins[uint(bin)], exposure_pixel_weight - upper);
      atomicAdd(group_bins[uint(bin) + 1u], upper);
    }
  }
  barrier();
  uint count = group_bins[gl_LocalInvocationIndex];
  if (count > 0u) atomicAdd(bins[gl_LocalInvocationIndex], count);
}
