#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The part of the light that arrives, from as many texels around as the samples are few.
#include "shared/ground.h"

layout(set = 1, binding = 0, std430) readonly buffer Texels { GroundTexel texels[]; };
layout(set = 1, binding = 1, std430) buffer Shade { float shade[]; };
layout(push_constant) uniform Constants { int radius; };

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= int(ground_side) || at.y >= int(ground_side)) return;
  ivec2 from = max(at - radius, 0), to = min(at + radius, int(ground_side) - 1);
  float arrived = 0.0, sent = 0.0;
  for (int y = from.y; y <= to.y; ++y) {
    for (int x = from.x; x <= to.x; ++x) {
      GroundTexel texel = texels[uint(y) * ground_side + uint(x)];
      arrived += texel.arrived;
      sent += texel.sent;
    }
  }
  shade[uint(at.y) * ground_side + uint(at.x)] = sent > 0.0 ? arrived / sent : 1.0;
}
