// The plane under the scene that catches its shadows: a square of texels, each of which knows how
// much of the light that would reach it does. They lie in the world, so that the camera does not
// matter.
#ifndef HELIOGRAPH_SHARED_GROUND_H
#define HELIOGRAPH_SHARED_GROUND_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint ground_side = 256u;        // texels
SHARED_CONSTANT uint ground_lights = 1024u;     // points of all lights, in a table
SHARED_CONSTANT uint ground_light_step = 633u;  // odd: samples of a texel visit them all in turn
SHARED_CONSTANT uint ground_rays = 4u;          // of each texel in a frame
// From where the shadows fade out, as a part of half the side.
SHARED_CONSTANT float ground_fade_start = 0.45f;

SHARED_CONSTANT uint ground_light_far = 0u;    // `place` is a direction toward it
SHARED_CONSTANT uint ground_light_point = 1u;  // `place` is where it is
SHARED_CONSTANT uint ground_light_area = 2u;   // likewise, on a surface

// A point of a light.
struct GroundLight {
  vec3 place;
  uint kind;
  vec3 axis;     // in which a spot light or an area shines
  float weight;  // luminance of its irradiance of the ground; where it has a place, at 1 metre
  float scale;   // of the cosine to the axis
  float offset;  // and what is added
  float range;   // metres; 0: unlimited
  float padding0;
};

// The light that a texel visits first: others around it begin at others, as evenly spread as the
// sequence R2 (Roberts 2018) makes them, so that the mean of a few texels knows all light.
SHARED_FUNCTION uint first_ground_light(uint texel) {
  return (texel % ground_side * 773u + texel / ground_side * 583u) % ground_lights;
}

// Luminance that has arrived, and that would have arrived without the scene.
struct GroundTexel {
  float arrived;
  float sent;
};

SHARED_END
#endif
