// Which pixels trace rays in a frame: the plan's words and constants, the same in C++ and GLSL.
#ifndef HELIOGRAPH_SHARED_SAMPLING_H
#define HELIOGRAPH_SHARED_SAMPLING_H
#include "types.h"
SHARED_BEGIN

// A word per pixel: what is traced for it in this frame; in the lower half the distance to what its
// reflection showed one frame ago (the upper half of a float; metres, 0: unknown); in the highest
// byte its ambient visibility then.
SHARED_CONSTANT uint plan_shadows = 0x10000u;
SHARED_CONSTANT uint plan_ambient = 0x20000u;
SHARED_CONSTANT uint plan_specular = 0x40000u;
SHARED_CONSTANT uint plan_all = 0x70000u;
// With plan_specular: the sample is a look-up of the environment instead of a ray.
SHARED_CONSTANT uint plan_environment = 0x80000u;
SHARED_CONSTANT uint plan_visibility_shift = 24u;
SHARED_CONSTANT float plan_visibility_steps = 255.0f;

// Every square of 4x4 pixels holds each of so many turns twice.
SHARED_CONSTANT uint plan_turns = 8u;
// Advances the turn from frame to frame: 2^32 times the golden ratio, less its whole part. No
// pattern of frames repeats, that of the jitter or of the random numbers either.
SHARED_CONSTANT uint plan_step = 0x9e3779b9u;

// What was fitted by measurement of similarity while the camera moves; SamplingPlan tests pin them.
// Single samples of less variance hardly differ: their mean is known after a quarter of the frames.
SHARED_CONSTANT float plan_quiet_variance = 0.05f;
SHARED_CONSTANT float plan_quiet_factor = 4.0f;
// The blur after it makes more of each sample of indirect light.
SHARED_CONSTANT float indirect_frames_factor = 2.0f;
// Reflections of smoother surfaces are sharp, those of more metallic ones most of what is seen:
// both are traced in every second frame at least.
SHARED_CONSTANT float plan_smooth_roughness = 0.15f;
SHARED_CONSTANT float plan_metallic = 0.5f;

// Albedo of what occludes reflections of which only the environment is looked up: fitted to the
// mean brightness of the test scenes.
SHARED_CONSTANT float expected_albedo = 0.3f;

// Of the random numbers that say to which side of a surface a gathering ray leaves that scatters
// light through.
SHARED_CONSTANT uint side_dimension = 60u;

// Hits of reflections that lie so far from what the frame before showed, as a fraction of their
// view Z, are not the same surface.
SHARED_CONSTANT float shown_depth_tolerance = 0.02f;

struct SamplingPlanConstants {
  float full_frames;   // shorter histories are sampled in every frame
  uint shadows_most;   // longer ones once in so many frames
  uint ambient_most;   // ambient visibility or indirect light
  uint ambient_least;  // and its shorter ones
  uint indirect_side;  // pixels per texel of its history's length; 0: that of ambient visibility
  uint specular_most;
  uint mirrors_most;    // of reflections on smooth or metallic surfaces
  float fade_start;     // roughness above which a growing fraction of pixels traces no reflection
  float fade_slope;     // fraction for each step of roughness
  float fade_fraction;  // the most
  uint faded;           // what their words hold instead of plan_specular
};

SHARED_END
#endif
