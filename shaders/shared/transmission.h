// Rays through blended surfaces that bend or blur light.
#ifndef HELIOGRAPH_SHARED_TRANSMISSION_H
#define HELIOGRAPH_SHARED_TRANSMISSION_H
#include "types.h"
SHARED_BEGIN

// Thin walls that are smoother do not visibly blur what is behind them.
SHARED_CONSTANT float least_blurring_roughness = 0.06f;

// Boundaries that a ray meets within a volume before it goes straight on.
SHARED_CONSTANT uint most_boundaries = 3u;

// Of the random numbers of these rays: order of the bands of wavelengths, direction behind the
// surface, and two for each boundary.
SHARED_CONSTANT uint band_dimension = 52u;
SHARED_CONSTANT uint entry_dimension = 53u;
SHARED_CONSTANT uint boundary_dimension = 54u;

SHARED_END
#endif
