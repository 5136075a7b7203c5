// The radiance cache: light that arrives at places of the world, found by a hash of their position
// and orientation. std430.
#ifndef HELIOGRAPH_SHARED_RADIANCE_CACHE_H
#define HELIOGRAPH_SHARED_RADIANCE_CACHE_H
#include "types.h"
SHARED_BEGIN

// Cells lie in buckets, in any of whose slots a cell may be. Key 0: the slot is free.
SHARED_CONSTANT uint cache_cells = 65536u;
SHARED_CONSTANT uint cache_bucket = 8u;
// Behind the keys: how many cells there are and how many of them may be updated, each counted in
// this frame and the frame before, and cleared for the next: a frame that was canceled finds what
// it found the first time.
SHARED_CONSTANT uint cache_counters = 3u;
SHARED_CONSTANT uint cache_counts = cache_cells;
SHARED_CONSTANT uint cache_used_counts = cache_cells + cache_counters;
SHARED_CONSTANT uint cache_words = cache_cells + 2u * cache_counters;
// Cells that nothing has asked for in so many frames are not updated, and freed after so many:
// sooner where there are more cells than this.
SHARED_CONSTANT uint cache_used_frames = 8u;
SHARED_CONSTANT uint cache_lifetime = 64u;
SHARED_CONSTANT uint cache_crowd = 49152u;
SHARED_CONSTANT uint cache_crowd_lifetime = 16u;
// Cells of fewer samples are updated so much more often.
SHARED_CONSTANT uint cache_new_samples = 4u;
SHARED_CONSTANT float cache_new_factor = 8.0f;
// Short rays ask for cells so many times half as large, at most: smaller ones are too many.
SHARED_CONSTANT int finer_levels = 2;
// Where a reflection shows a place that has no cell, so much of the sky is taken to light it.
SHARED_CONSTANT float unknown_openness = 0.5f;
// Reflections show the cells' light of lights where these are smaller than this fraction of the
// width of the specular lobe, which is taken to be the length of the ray times roughness squared.
SHARED_CONSTANT float cell_in_lobe = 1.0f;
// Mean cosine of the angle at which light from everywhere arrives. Surfaces that gathering rays
// meet send light on as if it came at this angle: Indirect.SpecularFloorsSendOnWhatTheyGet pins it.
SHARED_CONSTANT float mean_cosine = 2.0f / 3.0f;
// One of so many rays moves the cell that it asks for.
SHARED_CONSTANT uint moves_every = 8u;

// Probes are rays from the place of a cell before it moved to the new one, each raised from its
// surface by this fraction of the cell's size: what is lower does not hide them from each other.
SHARED_CONSTANT float cell_lift = 0.125f;
SHARED_CONSTANT uint probe_mark = 0x3f800000u;  // Ray::user of probes: the bits of 1.0
// How often a cell is split, by the plane of what a probe has met.
SHARED_CONSTANT uint most_splits = 3u;

// RadianceCell::state
SHARED_CONSTANT uint cell_rests = 0u;
SHARED_CONSTANT uint cell_updated = 1u;  // there is a sample of this frame
SHARED_CONSTANT uint cell_blocked = 2u;  // is split at the end of its update
SHARED_CONSTANT uint cell_split = 3u;    // knows nothing: its two halves are cells of their own
// RadianceCell::new_indirect, of each color, where a gathering ray has found nothing that is known.
SHARED_CONSTANT float nothing_gathered = -1.0f;
// Beside a cell's number in its shadow ray: the ray goes to an emissive triangle.
SHARED_CONSTANT uint cache_emissive_ray = 0x10000u;

struct RadianceCell {
  vec3 position;    // of a surface in the cell, world; of the plane that splits it
  uint last_used;   // number of the frame
  vec3 normal;      // of that surface, geometric; of the plane
  uint samples;     // in the means; 0: nothing is known
  vec3 direct;      // irradiance / pi by lights
  uint priority;    // random, of the place that it has been moved to in this frame
  vec3 indirect;    // and by everything else, emissive triangles too
  float size;       // edge length, metres
  vec3 new_direct;  // this frame's sample; of blocked cells the normal of the plane
  uint state;
  vec3 new_indirect;
  uint splits;     // of cells that this is a part of
  vec3 anchor;     // the place that probes have reached, raised; of blocked cells one on the plane
  uint moved;      // 1: since then
  uint bin;        // of the path guide, of this frame's gathering ray
  float gathered;  // luminance of what it brings
  uint padding0;
  uint padding1;
};

struct RadianceCacheConstants {
  uint frame_number;
  uint reset;           // 1: frees all cells
  uint forget;          // 1: their light has changed
  float cell_angle;     // size of cells as a fraction of their distance
  float cell_fraction;  // largest size as a fraction of the length of the ray that asks
  float least_size;     // metres
  uint most_samples;    // in a mean
  float updates;        // cells in each frame, about
  float least_weight;   // of a new sample
  uint guided;          // 1: gathering rays follow the path guide
};

SHARED_END
#endif
