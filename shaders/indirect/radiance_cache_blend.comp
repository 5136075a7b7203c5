#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Blends this frame's samples into the means of their cells.
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) buffer Keys { uint cache_keys[]; };
layout(set = 1, binding = 1, std430) buffer Cells { RadianceCell cells[]; };
layout(push_constant) uniform Constants { RadianceCacheConstants constants; };

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot == 0u) cache_keys[cache_counts + (constants.frame_number + 1u) % 2u] = 0u;
  if (cache_keys[slot] == 0u || cells[slot].updated == 0u) return;
  uint samples = min(cells[slot].samples + 1u, constants.most_samples);
  // The first samples know little of other cells' light: later ones weigh more.
  float weight = min(2.0 / float(samples + 1u), 1.0);
  cells[slot].direct = mix(cells[slot].direct, cells[slot].new_direct, weight);
  cells[slot].indirect = mix(cells[slot].indirect, cells[slot].new_indirect, weight);
  cells[slot].samples = samples;
}
