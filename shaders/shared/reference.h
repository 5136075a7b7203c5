// What the reference path tracer remembers of each pixel's path between passes: std430.
#ifndef HELIOGRAPH_SHARED_REFERENCE_H
#define HELIOGRAPH_SHARED_REFERENCE_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint path_specular = 1u;  // the ray left by the specular lobe, not the diffuse one,
                                          // or has passed the surface
SHARED_CONSTANT uint path_turned = 2u;    // the path was reflected or scattered before
SHARED_CONSTANT uint path_kept = ~3u;     // what of the flags surfaces change only if light passes:
SHARED_CONSTANT uint path_band_shift = 2u;    // which band of wavelengths the path has, 0: all,
SHARED_CONSTANT uint path_bands = 3u;         // 1 red, 2 green, 3 blue;
SHARED_CONSTANT uint path_medium_shift = 4u;  // number of the layer whose volume it is in; 0: none

// Of the random numbers that place a camera ray on the aperture; below those of the path's rounds.
SHARED_CONSTANT uint lens_dimension = 252u;

struct ReferencePath {
  vec3 throughput;
  uint bounces;       // scattering events so far
  float cone_width;   // metres, where the ray begins
  float cone_spread;  // metres per metre
  uint flags;         // path_*, the band and the medium
  float density;      // of the ray's direction, per steradian; 0: no other technique samples it
};

// What a pass is told.
struct ReferenceConstants {
  uint round;           // of shading, from 0
  uint limit;           // rounds of the primary surface; bounces of a whole path
  uint with_lights;     // 1: lights shade what specular rays hit
  float max_roughness;  // rougher surfaces reflect the prefiltered environment; below 0: all do
};

SHARED_END
#endif
