// The shared set 0: the frame's constants and the scene's tables.
#ifndef HELIOGRAPH_FRAME_GLSL
#define HELIOGRAPH_FRAME_GLSL
#include "shared/frame_constants.h"
#include "shared/scene.h"

layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameConstants frame; };
layout(set = 0, binding = 1, std140) uniform LightBlock { Light lights[uniform_lights]; };
layout(set = 0, binding = 2) uniform sampler2D environment_map;
layout(set = 0, binding = 3) uniform samplerCube prefiltered_environment;
layout(set = 0, binding = 4) uniform sampler2D split_sum_table;
layout(set = 0, binding = 5) uniform usamplerBuffer light_texels;
layout(set = 0, binding = 6) uniform sampler2D ltc_table;
layout(set = 0, binding = 7) uniform sampler2D background_map;
layout(set = 0, binding = 8) uniform usamplerBuffer environment_cells;
layout(set = 0, binding = 9) uniform sampler2D sheen_table;

layout(constant_id = 0) const uint scene_features = 0xffffffffu;
/// Whether the scene may have something; known when the shader is made.
bool scene_has(uint feature) { return (scene_features & feature) != 0u; }

bool enabled(uint flag) { return (frame.flags & flag) != 0u; }

bool outside_frame(ivec2 pixel) {
  return pixel.x >= int(frame.extent.x) || pixel.y >= int(frame.extent.y);
}

/// View-space position of a pixel's sample at `view_z` metres along -Z.
vec3 view_position(ivec2 pixel, float view_z) {
  vec2 ndc = (vec2(pixel) + 0.5) / vec2(frame.extent) * 2.0 - 1.0;
  vec2 slope = ndc * frame.unproject.xy + frame.unproject.zw;
  return vec3(enabled(frame_orthographic) ? slope : slope * view_z, -view_z);
}

vec3 world_position(ivec2 pixel, float view_z) {
  return (frame.inverse_view * vec4(view_position(pixel, view_z), 1.0)).xyz;
}

/// Unit vector from the surface (or the background) toward the eye, world space.
vec3 to_eye(ivec2 pixel) {
  vec3 view = enabled(frame_orthographic) ? vec3(0.0, 0.0, 1.0) : -view_position(pixel, 1.0);
  return normalize(mat3(frame.inverse_view) * view);
}

/// Size of a pixel at `view_z` metres along -Z, metres.
float pixel_footprint(float view_z) {
  float height = 2.0 * abs(frame.unproject.y) / float(frame.extent.y);
  return enabled(frame_orthographic) ? height : height * view_z;
}

/// How many pixels wide the lobe of a smooth surface shows what is far away: 2 alpha about the
/// reflected direction. In orthographic views, where that depends on the distance, more than
/// matters.
float lobe_pixels(float roughness) {
  return enabled(frame_orthographic) ? 1e6 : 2.0 * roughness * roughness / pixel_footprint(1.0);
}

#endif
