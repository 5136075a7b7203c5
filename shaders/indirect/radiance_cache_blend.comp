#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Blends this frame's samples into the means of their cells and into the path guide, and splits
// cells.
#include "shared/path_guide.h"
#include "shared/radiance_cache.h"

layout(set = 1, binding = 0, std430) buffer Keys { uint cache_keys[]; };
layout(set = 1, binding = 1, std430) buffer Cells { RadianceCell cells[]; };
layout(set = 1, binding = 2, std430) writeonly buffer Report { uint cells_alive; };
layout(set = 1, binding = 3, std430) buffer Guide { GuideEntry guide[]; };
layout(push_constant) uniform Constants { RadianceCacheConstants constants; };
#include "lib/lighting/path_guide.glsl"

/// The entry at a place, made where there is a free slot.
uint guide_slot(vec3 position, vec3 normal) {
  GuideKey key = guide_key(position, normal, constants.cell_angle, constants.least_size);
  for (uint i = 0u; i < guide_bucket; ++i) {
    uint before = atomicCompSwap(guide[key.first + i].check, 0u, key.check);
    if (before == 0u) guide[key.first + i].limits = even_limits();
    if (before == 0u || before == key.check) return key.first + i;
  }
  return no_guide;
}

/// Samples that others take at the same time may be lost.
void learn(RadianceCell cell) {
  uint slot = guide_slot(cell.position, cell.normal);
  if (slot == no_guide) return;
  guide[slot].last_used = constants.frame_number;
  guide[slot].counts[cell.bin] += 1.0;
  guide[slot].squares[cell.bin] += cell.gathered * cell.gathered;
}

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
  if (constants.guided != 0u && cells[slot].gathered >= 0.0) learn(cells[slot]);
}
