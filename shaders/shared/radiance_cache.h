// The radiance cache: light that arrives at places of the world, found by a hash of their position
// and orientation. std430.
#ifndef HELIOGRAPH_SHARED_RADIANCE_CACHE_H
#define HELIOGRAPH_SHARED_RADIANCE_CACHE_H
#include "types.h"
SHARED_BEGIN

// Cells lie in buckets, in any of whose slots a cell may be. Key 0: the slot is free.
SHARED_CONSTANT uint cache_cells = 65536u;
SHARED_CONSTANT uint cache_bucket = 8u;

struct RadianceCell {
  vec3 position;   // of a surface in the cell, world
  uint last_used;  // number of the frame
  vec3 normal;     // of that surface, geometric
  uint samples;    // in the means; 0: nothing is known
  vec3 direct;     // irradiance / pi by lights
  float padding0;
  vec3 indirect;   // and by everything else
  float padding1;
  vec3 new_direct;  // this frame's sample
  uint updated;     // 1: there is one
  vec3 new_indirect;
  float padding2;
};

struct RadianceCacheConstants {
  uint frame_number;
  uint reset;        // 1: forgets all cells
  float cell_angle;  // size of cells as a fraction of their distance
  float least_size;  // metres
  uint most_samples;  // in a mean
  uint lifetime;      // frames without use
  float update_probability;
  uint padding0;
};

SHARED_END
#endif
