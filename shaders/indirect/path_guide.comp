#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// What the entries of the path guide have learnt, as probabilities of bins for this frame's rays.
// Frees those that have learnt nothing for long.
#include "shared/path_guide.h"
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) buffer Guide { GuideEntry guide[]; };
layout(push_constant) uniform Constants { RadianceCacheConstants constants; };

void free_entry(uint slot) {
  guide[slot].check = 0u;
  for (uint i = 0u; i < guide_bins; ++i) guide[slot].squares[i] = guide[slot].counts[i] = 0.0;
}

/// Bins are drawn in proportion to the root of the mean squared light, which has the least variance.
/// Those of few samples are taken to be like the others.
void write_limits(uint slot, float count, float squares) {
  float mean = squares / max(count, 1.0);
  float roots[guide_bins];
  float sum = 0.0;
  for (uint i = 0u; i < guide_bins; ++i) {
    roots[i] = sqrt((guide[slot].squares[i] + mean) / (guide[slot].counts[i] + 1.0));
    sum += roots[i];
  }
  const float shared_out = float(guide_whole - guide_bins * guide_least);
  uvec4 limits = uvec4(0u);
  float before = 0.0;
  for (uint i = 0u; i < guide_bins; ++i) {
    float part = sum > 0.0 ? before / sum : float(i) / float(guide_bins);
    uint limit = i * guide_least + uint(shared_out * part + 0.5);
    limits[i >> 2u] |= limit << (8u * (i & 3u));
    before += roots[i];
  }
  guide[slot].limits = limits;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (constants.reset != 0u) free_entry(slot);
  if (guide[slot].check == 0u) return;
  if (constants.frame_number - guide[slot].last_used > guide_lifetime) {
    free_entry(slot);
    return;
  }
  float count = 0.0, squares = 0.0;
  for (uint i = 0u; i < guide_bins; ++i) count += guide[slot].counts[i];
  float kept = count > guide_memory ? 0.5 : 1.0;
  if (constants.forget != 0u) kept = min(kept, guide_memory_of_change / max(count, 1.0));
  for (uint i = 0u; i < guide_bins; ++i) {
    guide[slot].counts[i] *= kept;
    guide[slot].squares[i] *= kept;
    squares += guide[slot].squares[i];
  }
  write_limits(slot, kept * count, squares);
}
