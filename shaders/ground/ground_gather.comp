#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Adds what the rays of a texel have found to what is known of it.
#include "shared/ground.h"
#include "shared/ray.h"

layout(set = 1, binding = 0, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 1, std430) readonly buffer Occluded { uint occluded[]; };
layout(set = 1, binding = 2, std430) buffer Texels { GroundTexel texels[]; };
layout(push_constant) uniform Constants {
  float kept;  // the weight of what is known; 0: the memory is new
};

void main() {
  uint texel = gl_GlobalInvocationID.x;
  if (texel >= ground_side * ground_side) return;
  GroundTexel known = GroundTexel(0.0, 0.0);
  if (kept > 0.0) {
    known = texels[texel];
    known.arrived *= kept;
    known.sent *= kept;
  }
  for (uint i = 0u; i < ground_rays; ++i) {
    uint index = texel * ground_rays + i;
    float light = uintBitsToFloat(rays[index].user);
    known.sent += light;
    if (occluded[index] == 0u) known.arrived += light;
  }
  texels[texel] = known;
}
