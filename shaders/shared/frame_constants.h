// What every pass of a frame may need: one uniform block, std140. Members stand in groups of 16
// bytes, so that C++ and GLSL lay them out alike.
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
SHARED_CONSTANT uint frame_indirect = 256u;  // indirect diffuse light in place of ambient occlusion
SHARED_CONSTANT uint frame_light_grid = 512u;   // lights by shaders/shared/light_grid.h
SHARED_CONSTANT uint frame_refraction = 1024u;  // rays through blended surfaces

// Whether surfaces in view trace ambient occlusion. Blended ones do so beside indirect light, too.
SHARED_FUNCTION bool traces_ambient(uint flags) {
  return (flags & (frame_ambient_occlusion | frame_indirect)) == frame_ambient_occlusion;
}

struct FrameConstants {
  mat4 view_projection;      // world -> clip, with this sample's jitter
  mat4 unjittered;           // world -> clip, without
  mat4 previous_unjittered;  // the same, one frame ago
  mat4 view;                 // world -> view
  mat4 previous_view;
  mat4 inverse_view;  // view -> world
  vec4 unproject;     // view xy = (ndc * xy + zw) x view Z (perspective)
  vec4 eye;           // world, metres

  uvec2 extent;       // width and height, pixels
  uint sample_index;  // frames since the history was reset: index into all random sequences
  uint seed;          // of the random sequences

  uint light_count;         // with the environment's sun, which is the last
  uint flags;               // frame_*
  uint prefiltered_levels;  // mip levels of the prefiltered environment cube
  uint history_invalid;     // 1: no history image may be read

  float environment_intensity;
  float environment_cos;  // of the environment's rotation about Y
  float environment_sin;
  float ambient_radius;  // how far occluders count, metres

  float exposure_factor;
  uint tone_map_curve;             // protocol::ToneMapCurve
  float directional_light_radius;  // tangent of the angular radius of all, -1: each has its own
  float texture_footprint;         // of a pixel, pixels: less where frames are drawn smaller

  vec4 irradiance[9];          // spherical harmonics of the irradiance / pi, rgb
  vec3 sun_direction;          // toward the environment's sun, world
  float sun_radius;            // tangent of its angular radius, -1: there is none
  vec3 sun_irradiance;         // on a surface facing it
  float background_intensity;  // factor on the map of what is seen behind the scene

  float lens_radius;     // of the aperture, metres; 0: everything is sharp
  float focus_distance;  // along the view, metres
  float padding0;
  float padding1;

  vec4 ground;  // middle of the plane that catches shadows, metres; half its side, 0: there is none
};

SHARED_END
#endif
