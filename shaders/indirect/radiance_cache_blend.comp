#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Blends this frame's samples into the means of their cells, and splits cells.
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) buffer Keys { uint cache_keys[]; };
layout(set = 1, binding = 1, std430) buffer Cells { RadianceCell cells[]; };
layout(set = 1, binding = 2, std430) writeonly buffer Report { uint cells_alive; };
layout(push_constant) uniform Constants { RadianceCacheConstants constants; };

void main() {
  uint slot = gl_GlobalInvocationID.x;
  uint next = (constants.frame_number + 1u) % cache_counters;
  if (slot == 0u) {
    cells_alive = cache_keys[cache_counts + constants.frame_number % cache_counters];
    cache_keys[cache_counts + next] = cache_keys[cache_used_counts + next] = 0u;
  }
  if (cache_keys[slot] == 0u) return;
  if (cells[slot].state == cell_blocked) {
    cells[slot].position = cells[slot].anchor;
    cells[slot].normal = cells[slot].new_direct;
    cells[slot].direct = cells[slot].indirect = vec3(0.0);
    cells[slot].samples = 0u;
    cells[slot].state = cell_split;
  }
  if (cells[slot].state != cell_updated) return;
  uint samples = min(cells[slot].samples + 1u, constants.most_samples);
  // The first samples know little of other cells' light: later ones weigh more.
  float weight = min(max(2.0 / float(samples + 1u), constants.least_weight), 1.0);
  cells[slot].direct = mix(cells[slot].direct, cells[slot].new_direct, weight);
  if (cells[slot].new_indirect.x >= 0.0) {
    cells[slot].indirect = mix(cells[slot].indirect, cells[slot].new_indirect, weight);
  }
  cells[slot].samples = samples;
}
