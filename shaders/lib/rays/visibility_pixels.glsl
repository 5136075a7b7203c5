// Which pixels trace a ray for a visibility signal. Include after declaring the images `motion`,
// `planned` and `visibility` and the constant `by_plan`.
#ifndef HELIOGRAPH_VISIBILITY_PIXELS_GLSL
#define HELIOGRAPH_VISIBILITY_PIXELS_GLSL
#include "lib/rays/sampling_plan.glsl"

/// What a pixel's visibility is before its ray was traced.
void leave(ivec2 pixel, float visible) { imageStore(visibility, pixel, vec4(visible)); }

/// Whether a pixel's ray is to be made; otherwise its visibility is left: `background` where there
/// is no surface. `plan_bit`: of the signal in the sampling plan.
bool wants_ray(ivec2 pixel, uint plan_bit, float background) {
  if (outside_frame(pixel)) return false;
  bool seen = imageLoad(motion, pixel).w > 0.0;
  bool left_out = seen && by_plan != 0u && (imageLoad(planned, pixel).r & plan_bit) == 0u;
  if (seen && !left_out) return true;
  leave(pixel, left_out ? no_sample : background);
  return false;
}

#endif
