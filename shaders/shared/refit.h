// What brings the trees of deforming meshes to new positions, the same in C++ and GLSL.
#ifndef HELIOGRAPH_SHARED_REFIT_H
#define HELIOGRAPH_SHARED_REFIT_H
#include "types.h"
SHARED_BEGIN

// A triangle of a BvhTriangle table: its place there, and the positions of its corners.
struct RefitTriangle {
  uint slot;
  uint corner0;
  uint corner1;
  uint corner2;
};

// The least coordinate of the box of nothing; the greatest is its negative.
SHARED_CONSTANT float refit_empty = 3e38;

// Invocations of a group that refits boxes.
SHARED_CONSTANT uint refit_group = 256u;

// Levels of trees that a pass refits, from the leaves up: a node lies above all nodes of its
// subtree. Several only where one group does it all.
struct RefitLevels {
  uint first;
  uint end;
};

SHARED_END
#endif
