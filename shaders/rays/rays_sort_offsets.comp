#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 256) in;
// Counting sort of a ray stream, second: where the rays of each key begin. One group.
#include "shared/ray_sorting.h"

layout(set = 1, binding = 0, std430) buffer Places { uint places[]; };

const uint keys_per_lane = ray_keys / 256u;
shared uint sums[256];

void main() {
  uint lane = gl_LocalInvocationIndex;
  uint own = 0u;
  for (uint i = 0u; i < keys_per_lane; ++i) own += places[lane * keys_per_lane + i];
  sums[lane] = own;
  barrier();
  for (uint reach = 1u; reach < 256u; reach *= 2u) {
    uint before = lane >= reach ? sums[lane - reach] : 0u;
    barrier();
    sums[lane] += before;
    barrier();
  }
  uint place = sums[lane] - own;
  for (uint i = 0u; i < keys_per_lane; ++i) {
    uint count = places[lane * keys_per_lane + i];
    places[lane * keys_per_lane + i] = place;
    place += count;
  }
}
