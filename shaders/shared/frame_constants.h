// What every pass of a frame may need: one uniform block, std140 (vec4 aligned throughout).
#ifndef HELIOGRAPH_SHARED_FRAME_CONSTANTS_H
#define HELIOGRAPH_SHARED_FRAME_CONSTANTS_H
#include "types.h"
SHARED_BEGIN

SHARED_CONSTANT uint frame_shadows = 1u;
SHARED_CONSTANT uint frame_ambient_occlusion = 2u;
SHARED_CONSTANT uint frame_direct = 4u;
SHARED_CONSTANT uint frame_environment_diffuse = 8u;
SHARED_CONSTANT uint frame_environment_specular = 16u;
SHARED_CONSTANT uint frame_emissive = 32u;
SHARED_CONSTANT uint frame_environment_visible = 64u;
SHARED_CONSTANT uint frame_orthographic = 128u;

struct FrameConstants {
  mat4 view_projection;      // world -> clip, with this sample's jitter
  mat4 unjittered;           // world -> clip, without
  mat4 previous_unjittered;  // the same, one frame ago
  mat4 view;                 // world -> view
  mat4 previous_view;
  mat4 inverse_view;    // view -> world
  vec4 unproject;       // view xy = (ndc * xy + zw) x view Z (perspective)
  vec4 eye;             // world, metres
  uvec4 extent;         // width, height, frames since the last cut, random seed
  uvec4 counts;         // lights with the environment's sun, frame_* flags, levels of the
                        // prefiltered cube, 1 where no history holds
  vec4 environment;     // intensity, cos and sin of the rotation, ambient radius (metres)
  vec4 exposure;        // factor, tone map curve, tangent of the sun radius or -1, unused
  vec4 irradiance[9];   // spherical harmonics of the irradiance / pi, rgb
  vec4 sun;             // toward the environment's sun, world; w: tangent of its angular
                        // radius, -1: there is none
  vec4 sun_irradiance;  // rgb, on a surface facing it
};

SHARED_END
#endif
