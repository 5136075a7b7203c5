#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The weight of the filtered mean in the frame that is shown: 1 - v / max(d, v), where v is the
// mean's variance and d its squared distance from the denoised frame, both over 5x5 pixels;
// averaged over 3x3.
#include "lib/frame.glsl"
#include "lib/lighting/lights.glsl"
#include "shared/exposure.h"

layout(set = 1, binding = 0) uniform sampler2D radiance;
layout(set = 1, binding = 1, rgba16f) readonly uniform image2D filtered;  // a: deviation
layout(set = 1, binding = 2, std140) uniform ExposureBlock { ExposureState exposure; };
layout(set = 1, binding = 3, r32f) writeonly uniform image2D mean_weight;
layout(push_constant) uniform Constants { uvec2 shown; };  // size of all images, pixels

const int window = 2;  // pixels on either side that are averaged
const int reach = window + 1;
const int side = 8 + 2 * reach;
const int weights_side = 10;

shared vec2 pixels[side * side];  // variance and squared distance
shared float weights[weights_side * weights_side];

/// Both in units of the exposed image, in which bright pixels differ less.
vec2 compared(ivec2 pixel) {
  float seen = luminance(texelFetch(radiance, pixel, 0).rgb);
  vec4 mean = imageLoad(filtered, pixel);
  float averaged = luminance(mean.rgb);
  float compression = 1.0 / (1.0 + 0.5 * exposure.factor * (seen + averaged));
  float apart = averaged - seen;
  return vec2(mean.a * mean.a, apart * apart) * compression * compression;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 corner = ivec2(gl_WorkGroupID.xy) * 8 - reach;
  ivec2 last = ivec2(shown) - 1;
  for (int i = int(gl_LocalInvocationIndex); i < side * side; i += 64) {
    pixels[i] = compared(clamp(corner + ivec2(i % side, i / side), ivec2(0), last));
  }
  barrier();
  for (int i = int(gl_LocalInvocationIndex); i < weights_side * weights_side; i += 64) {
    ivec2 at = corner + window + ivec2(i % weights_side, i / weights_side);
    ivec2 middle = clamp(at, ivec2(0), last) - corner;
    vec2 sum = vec2(0.0);
    for (int y = -window; y <= window; ++y) {
      for (int x = -window; x <= window; ++x) {
        sum += pixels[(middle.y + y) * side + middle.x + x];
      }
    }
    // Where there is a number that is none, the frame is shown.
    weights[i] = sum.y > sum.x ? 1.0 - sum.x / sum.y : 0.0;
  }
  barrier();
  if (any(greaterThanEqual(uvec2(pixel), shown))) return;
  float total = 0.0;
  ivec2 own = ivec2(gl_LocalInvocationID.xy);
  for (int i = 0; i < 9; ++i) total += weights[(own.y + i / 3) * weights_side + own.x + i % 3];
  imageStore(mean_weight, pixel, vec4(total / 9.0));
}
