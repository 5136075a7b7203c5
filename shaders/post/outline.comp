#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Draws an outline around the pixels of selected instances over the finished frame, where their
// Gaussian coverage is between none and all.
#include "shared/types.h"

layout(set = 1, binding = 0, r32ui) readonly uniform uimage2D instance;  // instance + 1, 0: none
layout(set = 1, binding = 1, std430) readonly buffer Selection { uint selection[]; };
layout(set = 1, binding = 2, rgba8) uniform image2D shown;
layout(push_constant) uniform Constants {
  vec4 color;          // sRGB
  uvec2 shown_size;    // pixels
  uvec2 drawn;         // size of `instance`
  vec2 sample_offset;  // of what pixels of `instance` show from their centres
};

const int taps = 6;

bool is_selected(ivec2 pixel) {
  uint id = imageLoad(instance, clamp(pixel, ivec2(0), ivec2(drawn) - 1)).r;
  return id != 0u && ((selection[(id - 1u) / 32u] >> ((id - 1u) % 32u)) & 1u) != 0u;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(pixel), shown_size))) return;
  vec2 centre = (vec2(pixel) + 0.5) * vec2(drawn) / vec2(shown_size) - sample_offset - 0.5;
  ivec2 first = ivec2(floor(centre)) - taps / 2 + 1;
  float covered = 0.0, sum = 0.0;
  for (int y = 0; y < taps; ++y) {
    for (int x = 0; x < taps; ++x) {
      ivec2 tap = first + ivec2(x, y);
      vec2 distance = vec2(tap) - centre;
      float weight = exp(-0.5 * dot(distance, distance));
      sum += weight;
      if (is_selected(tap)) covered += weight;
    }
  }
  float coverage = covered / sum;
  float share = 4.0 * coverage * (1.0 - coverage);
  if (share <= 0.0) return;
  vec4 before = imageLoad(shown, pixel);
  imageStore(shown, pixel, vec4(mix(before.rgb, color.rgb, share), 1.0));
}
