// The radiance cache: light that arrives at places of the world, found by a hash of their position
// and orientation. std430.
#ifndef HELIOGRAPH_SHARED_RADIANCE_CACHE_H
#define HELIOGRAPH_SHARED_RADIANCE_CACHE_H
#include "types.h"
SHARED_BEGIN

// Cells lie in buckets, in any of whose slots a cell may be. Key 0: the slot is free.
SHARED_CONSTANT uint cache_cells = 65536u;
SHARED_CONSTANT uint cache_bucket = 8u;
// Behind the keys: how many cells there are, counted in frames of even and of odd numbers.
SHARED_CONSTANT uint cache_counts = cache_cells;
SHARED_CONSTANT uint cache_words = cache_cells + 2u;
// Cells of fewer samples are updated so much more often.
SHARED_CONSTANT uint cache_new_samples = 4u;
SHARED_CONSTANT float cache_new_factor = 8.0f;
// Short rays ask for cells so many times half as large, at most: smaller ones are too many.
SHARED_CONSTANT int finer_levels = 2;
// Where a reflection shows a place that has no cell, so much of the sky is taken to light it.
SHARED_CONSTANT float unknown_openness = 0.5f;
// One of so many rays moves the cell that it asks for.
SHARED_CONSTANT uint moves_every = 8u;

struct RadianceCell {
  vec3 position;   // of a surface in the cell, world
  uint last_used;  // number of the frame
  vec3 normal;     // of that surface, geometric
  uint samples;    // in the means; 0: nothing is known
  vec3 direct;     // irradiance / pi by lights
  uint priority;   // random, of the place that it has been moved to in this frame
  vec3 indirect;   // and by everything else
  float padding1;
  vec3 new_direct;  // this frame's sample
  uint updated;     // 1: there is one
  vec3 new_indirect;
  float padding2;
};

struct RadianceCacheConstants {
  uint frame_number;
  uint reset;           // 1: forgets all cells
  float cell_angle;     // size of cells as a fraction of their distance
  float cell_fraction;  // largest size as a fraction of the length of the ray that asks
  float least_size;     // metres
  uint most_samples;    // in a mean
  uint lifetime;        // frames without use
  float updates;        // cells in each frame, about
  float least_weight;   // of a new sample
};

SHARED_END
#endif
