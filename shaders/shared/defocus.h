// How the frame is blurred by a lens: limits that shaders and host kernels share.
#ifndef HELIOGRAPH_SHARED_DEFOCUS_H
#define HELIOGRAPH_SHARED_DEFOCUS_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint defocus_samples = 24u;     // of a pixel's own circle, and of those in front
SHARED_CONSTANT float defocus_limit = 12.0f;    // a circle's radius is at most height / this
SHARED_CONSTANT uint defocus_rows = 24u;        // of tiles, at most
SHARED_CONSTANT float defocus_parting = 0.05f;  // of the distance: so far in front is in front

// Side of a tile, pixels: no circle reaches farther than two tiles.
SHARED_FUNCTION uint defocus_tile(uvec2 extent) {
  return (extent.y + defocus_rows - 1u) / defocus_rows;
}

// How many tiles there are across and down.
SHARED_FUNCTION uvec2 defocus_tiles(uvec2 extent) {
  uint side = defocus_tile(extent);
  return (extent + side - 1u) / side;
}

SHARED_END
#endif
