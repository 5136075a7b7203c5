#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 256) in;
// Where each restart interval of a JPEG begins in the file: the sums of the lengths before it, with
// a marker behind each.
#include "shared/jpeg.h"

layout(set = 1, binding = 0, std430) readonly buffer Lengths { uint lengths[]; };  // bytes
/// One more than there are intervals; the last is the length of all, or 0 where one does not fit.
layout(set = 1, binding = 1, std430) writeonly buffer Places { uint places[]; };
layout(set = 1, binding = 2, std430) writeonly buffer Report { uint total; };
layout(push_constant) uniform Constants { uint intervals; };

const uint threads = 256u;
const uint marker_bytes = 2u;
shared uint sums[threads];
shared uint too_long;

void main() {
  uint thread = gl_LocalInvocationIndex;
  if (thread == 0u) too_long = 0u;
  barrier();
  uint share = (intervals + threads - 1u) / threads;
  uint first = min(thread * share, intervals);
  uint end = min(first + share, intervals);
  uint sum = 0u;
  for (uint i = first; i < end; ++i) {
    if (lengths[i] == jpeg_too_long) atomicOr(too_long, 1u);
    sum += lengths[i] + marker_bytes;
  }
  sums[thread] = sum;
  barrier();
  for (uint step = 1u; step < threads; step *= 2u) {
    uint before = thread >= step ? sums[thread - step] : 0u;
    barrier();
    sums[thread] += before;
    barrier();
  }
  uint place = sums[thread] - sum;
  for (uint i = first; i < end; ++i) {
    places[i] = place;
    place += lengths[i] + marker_bytes;
  }
  if (thread != threads - 1u) return;
  uint all = too_long == 0u ? sums[thread] : 0u;
  places[intervals] = all;
  total = all;
}
