#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 256) in;
// Counting sort of a ray stream, second: where the rays of each key begin. One group.
#include "shared/ray_sorting.h"

layout(set = 1, binding = 0, std430) buffer Offsets { uint offsets[]; };

const uint keys_per_lane = ray_keys / 256u;
shared uint sums[256];

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint own = 0u;
  for (uint i = 0u; i < keys_per_lane; ++i) own += offsets[lane * keys_per_lane + i];
  sums[lane] = own;
  barrier();
  for (uint stride = 1u; stride < 256u; stride *= 2u) {
    uint before = lane >= stride ? sums[lane - stride] : 0u;
    barrier();
    sums[lane] += before;
    barrier();
  }
  uint offset = sums[lane] - own;
  for (uint i = 0u; i < keys_per_lane; ++i) {
    uint count = offsets[lane * keys_per_lane + i];
    offsets[lane * keys_per_lane + i] = offset;
    offset += count;
  }
}
