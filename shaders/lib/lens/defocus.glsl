// Circles of confusion of a thin lens (Potmesil and Chakravarty 1981).
#ifndef HELIOGRAPH_DEFOCUS_GLSL
#define HELIOGRAPH_DEFOCUS_GLSL
#include "lib/frame.glsl"
#include "shared/defocus.h"

const float beyond_all = 1e30;

/// Along the view, metres; the G-buffer has 0 where nothing is.
float distance_of(float view_z) { return view_z > 0.0 ? view_z : beyond_all; }

/// Radius of the circle that a point shows as, pixels.
float blur_radius(float distance) {
  float shift = frame.lens_radius * abs(1.0 / frame.focus_distance - 1.0 / distance);
  return min(shift / pixel_footprint(1.0), float(frame.extent.y) / defocus_limit);
}

#endif
