// Drawing directions of gathering rays where light has come from before (path guiding in primary
// sample space): the square that is mapped to the hemisphere is divided into bins, each drawn with
// a probability that the guide has learnt. A pass declares the buffer `guide` before it includes
// this.
#ifndef HELIOGRAPH_PATH_GUIDE_GLSL
#define HELIOGRAPH_PATH_GUIDE_GLSL
#include "lib/frame.glsl"
#include "lib/lighting/cell_level.glsl"
#include "lib/math/geometry.glsl"
#include "lib/math/random.glsl"
#include "shared/path_guide.h"

const uint no_guide = 0xffffffffu;

struct GuideKey {
  uint first;  // slot of its bucket
  uint check;
};

/// `normal`: geometric, on the side that light comes from. `cell_angle`, `least_size`: of the cache.
GuideKey guide_key(vec3 position, vec3 normal, float cell_angle, float least_size) {
  int level = cell_level(position, cell_angle, least_size) + guide_coarser;
  uvec3 hashed = pcg3d(uvec3(ivec3(floor(position * exp2(float(-level))))));
  hashed = pcg3d(hashed + uvec3(uint(level + 64) * 8u + normal_axis(normal), 0u, 0u));
  return GuideKey((hashed.x % (guide_entries / guide_bucket)) * guide_bucket, max(hashed.y, 1u));
}

uint find_guide(GuideKey key) {
  for (uint i = 0u; i < guide_bucket; ++i) {
    if (guide[key.first + i].check == key.check) return key.first + i;
  }
  return no_guide;
}

struct GuidedPair {
  vec2 u;        // in [0, 1)
  uint bin;
  float weight;  // density without a guide over that with it
};

uint bin_of(vec2 u) {
  uint ring = min(uint(u.x * float(guide_rings)), guide_rings - 1u);
  return ring * guide_sectors + min(uint(u.y * float(guide_sectors)), guide_sectors - 1u);
}

uint limit_of(uvec4 limits, uint bin) {
  if (bin == guide_bins) return guide_whole;
  return bitfieldExtract(limits[bin >> 2u], int(bin & 3u) * 8, 8);
}

/// Of an entry that has learnt nothing.
uvec4 even_limits() {
  uvec4 limits = uvec4(0u);
  for (uint i = 0u; i < guide_bins; ++i) {
    limits[i >> 2u] |= (i * (guide_whole / guide_bins)) << (8u * (i & 3u));
  }
  return limits;
}

/// The numbers that take the place of `u`.
GuidedPair guided_pair(vec2 u, uvec4 limits) {
  float at = u.x * float(guide_whole);
  uint bin = 0u;
  for (uint bit = guide_bins / 2u; bit > 0u; bit /= 2u) {
    if (float(limit_of(limits, bin + bit)) <= at) bin += bit;
  }
  float first = float(limit_of(limits, bin));
  float share = float(limit_of(limits, bin + 1u)) - first;
  vec2 within = vec2(min((at - first) / share, 1.0 - exp2(-24.0)), u.y);
  vec2 corner = vec2(bin / guide_sectors, bin % guide_sectors);
  vec2 bins = vec2(guide_rings, guide_sectors);
  return GuidedPair(min((corner + within) / bins, 1.0 - exp2(-24.0)), bin,
                    float(guide_whole) / (float(guide_bins) * share));
}

/// `u` as it is where the guide knows nothing.
GuidedPair guided_pair_at(vec3 position, vec3 normal, vec2 u, float cell_angle,
                          float least_size) {
  uint slot = find_guide(guide_key(position, normal, cell_angle, least_size));
  if (slot == no_guide) return GuidedPair(u, bin_of(u), 1.0);
  return guided_pair(u, guide[slot].limits);
}

#endif
