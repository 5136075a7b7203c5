// Emissive triangles as a table of lights: std430.
#ifndef HELIOGRAPH_SHARED_EMISSIVE_H
#define HELIOGRAPH_SHARED_EMISSIVE_H
#include "types.h"
SHARED_BEGIN

// In front of the table's entries.
struct EmissiveHeader {
  uint count;   // entries; 0: nothing shines
  float power;  // sum over all entries: luminance x square metres x pi, of each side that shines
  uint padding0;
  uint padding1;
};

// All triangles of an instance stand in a row, in the order of its mesh.
struct EmissiveTriangle {
  uint instance;
  uint triangle;      // within the instance's mesh
  float probability;  // with which it is drawn: its share of the power when the table was made
  float threshold;    // below it a number in [0, 1) stays with this entry, else it takes
  uint alias;         // this one
};

// In the list of every instance's first entry: one that is no light.
SHARED_CONSTANT uint no_emissive = 0xffffffffu;

// Points of emissive triangles that all receivers of a frame choose from.
struct EmissivePoint {
  vec3 position;  // world
  float density;  // per square metre; 0: nothing was drawn
  vec3 normal;    // of the front face
  float both;     // 1: the back shines, too
  vec3 emission;  // radiance
  float padding0;
};
SHARED_CONSTANT uint emissive_points = 1024u;
// Points that one receiver weighs, each from another part of the table.
SHARED_CONSTANT uint emissive_candidates = 8u;

SHARED_END
#endif
