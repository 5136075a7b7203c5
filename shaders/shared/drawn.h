// Triangles in world space that are drawn where camera rays would find them.
#ifndef HELIOGRAPH_SHARED_DRAWN_H
#define HELIOGRAPH_SHARED_DRAWN_H
#include "types.h"
SHARED_BEGIN

// Triangles whose rectangle has at most so many pixels are drawn by one invocation each.
SHARED_CONSTANT uint small_triangle_pixels = 64u;
// Those of larger ones are divided into parts of at most so many pixels a side, of a group each.
SHARED_CONSTANT uint drawn_part_side = 32u;

// Of a triangle.
struct DrawnPart {
  uint slot;   // of the hierarchy's triangles, with drawn_edge_on_bit (drawn_triangles.glsl)
  uint first;  // x | y << 16 of the first pixel
  uint last;   // and of the last
  uint padding0;
};

// Camera rays are found by tiles of 8 x 8 pixels.
SHARED_CONSTANT uint tile_pixels = 64u;

// How the rays of a tile find what they meet first.
SHARED_CONSTANT uint tile_drawn = 0u;
SHARED_CONSTANT uint tile_drawn_and_traced = 1u;  // the nearer of both
SHARED_CONSTANT uint tile_traced = 2u;            // without what is drawn

SHARED_END
#endif
