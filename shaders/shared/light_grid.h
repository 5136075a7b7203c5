// Which lights count where: for each cube of a grid over the scene a cut through a tree of the
// punctual lights (Walter et al. 2005). Behind the lights in their table, in texels of 16 bytes:
// header, entries, slots, numbers of the lights outside of the grid.
#ifndef HELIOGRAPH_SHARED_LIGHT_GRID_H
#define HELIOGRAPH_SHARED_LIGHT_GRID_H
#include "types.h"
SHARED_BEGIN

// Fewer punctual lights are all summed.
SHARED_CONSTANT uint least_grid_lights = 17u;
SHARED_CONSTANT uint most_light_cells = 4096u;
// Of a cell; after the last stands one without slots, where there are fewer.
SHARED_CONSTANT uint most_light_entries = 22u;
SHARED_CONSTANT uint texels_per_light_header = 4u;
SHARED_CONSTANT uint no_single_light = 0xffffffffu;
// From entry to entry, of the random number that picks a light from each: the golden ratio.
SHARED_CONSTANT float light_pick_step = 0.61803399;
// Which random numbers of a pixel these are: the same where its light and its shadows are computed.
SHARED_CONSTANT uint light_picks_dimension = 9u;

struct LightGridHeader {
  vec3 origin;         // of the first cell, world
  float inverse_size;  // cells per metre
  uvec3 cells;         // along each axis; what lies beyond has the list after theirs
  uint has_spots;
  uint first_entry;  // texels in the table
  uint first_slot;
  uint first_outside;
  uint outside_count;  // lights that belong to no cell: directional ones and those with an area
  uint slot_count;
  uint padding0;
  uint padding1;
  uint padding2;
};

// Some lights of the tree: those of a run of slots.
struct LightEntry {
  uint first_slot;
  uint slots;   // 0: none, and none after it
  uint single;  // the light's number where there is only one
  uint padding0;
};

// Each light has as many as its intensity deserves, and at least one.
struct LightSlot {
  uint light;   // number
  float share;  // 1 / the light's number of slots
  uint padding0;
  uint padding1;
};

SHARED_END
#endif
