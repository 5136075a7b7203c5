// Deferred composition: analytic light x traced visibility, mirrored light, image based light,
// emission. The image that a pass binds after these is its own affair.
#ifndef HELIOGRAPH_COMPOSITION_GLSL
#define HELIOGRAPH_COMPOSITION_GLSL
#include "lib/frame.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba8) readonly uniform image2D base_color;
layout(set = 1, binding = 2, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 3, rgba32ui) readonly uniform uimage2D surface_layers;
layout(set = 1, binding = 4, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 5, rgba16f) readonly uniform image2D emissive;
layout(set = 1, binding = 6, rgba32f) readonly uniform image2D background;
layout(set = 1, binding = 7, r32f) readonly uniform image2D shadow_visibility;
layout(set = 1, binding = 8, r32f) readonly uniform image2D ambient_visibility;
layout(set = 1, binding = 9, rgba32f) readonly uniform image2D specular_radiance;
layout(push_constant) uniform Constants { float max_roughness; };  // below 0: nothing was traced

#include "lib/scene/gbuffer_material.glsl"
#include "lib/lighting/lights.glsl"
#include "lib/math/sampling.glsl"
#include "lib/rays/specular_pixels.glsl"

/// What each signal of a pixel is multiplied by, and what needs none.
struct Shares {
  vec3 own;      // emission, background
  vec3 direct;   // of the shadow ratio
  vec3 ambient;  // of the ambient visibility
  vec3 mirror;   // of the specular signal
};

vec3 direct_light(SurfaceMaterial m, vec3 position) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.light_count; ++i) {
    if (light_reaches(i, position)) sum += light_contribution(light_number(i), m, position);
  }
  return sum;
}

Shares lit_shares(ivec2 pixel, float view_z) {
  SurfaceMaterial m = material_at(pixel);
  Shares shares = Shares(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  if (enabled(frame_direct)) shares.direct = direct_light(m, world_position(pixel, view_z));
  if (enabled(frame_environment_diffuse)) shares.ambient = environment_diffuse(m);
  if (mirrors_rays(mirror_roughness(m), max_roughness)) {
    shares.mirror = specular_demodulator(m);
  } else if (enabled(frame_environment_specular)) {
    shares.ambient += environment_specular(m);
  }
  shares.ambient *= imageLoad(base_color, pixel).a;  // the occlusion texture
  return shares;
}

Shares pixel_shares(ivec2 pixel) {
  float view_z = imageLoad(motion, pixel).w;
  if (view_z <= 0.0) {
    vec3 behind = imageLoad(background, pixel).rgb;
    return Shares(behind, vec3(0.0), vec3(0.0), vec3(0.0));
  }
  Shares shares;
  if (is_unlit(pixel)) {
    vec3 root = imageLoad(base_color, pixel).rgb;
    shares = Shares(root * root, vec3(0.0), vec3(0.0), vec3(0.0));
  } else {
    shares = lit_shares(pixel, view_z);
  }
  if (enabled(frame_emissive)) shares.own += imageLoad(emissive, pixel).rgb;
  return shares;
}

/// The picture's radiance from its signals. One bad pixel must not spread through the history.
vec4 composed(Shares shares, vec2 visibility, vec3 mirrored) {
  float lit = enabled(frame_shadows) ? visibility.x : 1.0;
  float open = enabled(frame_ambient_occlusion) ? visibility.y : 1.0;
  vec3 radiance = shares.own + shares.direct * lit + shares.ambient * open +
                  shares.mirror * mirrored;
  if (any(isnan(radiance)) || any(isinf(radiance))) radiance = vec3(0.0);
  return vec4(radiance, 1.0);
}

vec4 composed_of_raw_signals(Shares shares, ivec2 pixel) {
  vec2 visibility =
      vec2(imageLoad(shadow_visibility, pixel).r, imageLoad(ambient_visibility, pixel).r);
  vec3 mirrored = max_roughness < 0.0 ? vec3(0.0) : imageLoad(specular_radiance, pixel).rgb;
  return composed(shares, visibility, mirrored);
}

#endif
