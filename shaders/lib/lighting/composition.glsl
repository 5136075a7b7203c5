// Deferred composition: analytic light x traced visibility, specular light, image based light,
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
layout(set = 1, binding = 10, rgba32f) readonly uniform image2D indirect_radiance;
layout(push_constant) uniform Constants {
  float max_roughness;  // below 0: nothing was traced
  uint has_background;  // 0: `background` has no content
  uint makes_noisy;     // 0: denoised radiance alone
};

#include "lib/scene/gbuffer_material.glsl"
#include "lib/lighting/light_grid.glsl"
#include "lib/math/random.glsl"
#include "lib/math/sampling.glsl"
#include "lib/rays/specular_pixels.glsl"

/// What each signal of a pixel is multiplied by, and what needs none.
struct Composition {
  vec3 own;      // emission, background
  vec3 direct;   // of the shadow ratio
  vec3 ambient;  // of the ambient visibility
  vec3 specular;   // of the specular signal
  vec3 indirect;   // of the indirect diffuse light
  float sky;       // luminance of that if nothing hid the environment, where `ambient` shows it
};

/// Of what no signal lights.
Composition without_light(vec3 own) {
  return Composition(own, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
}

/// What the indirect signal is where nothing hides the environment.
vec3 open_indirect(SurfaceMaterial m) {
  if (!scatters_through(m)) return environment_irradiance(m.normal);
  return environment_diffuse(m) / max(spread_albedo(m), vec3(1e-6));
}

Composition lit_composition(ivec2 pixel, float view_z) {
  SurfaceMaterial m = material_at(pixel);
  Composition terms = without_light(vec3(0.0));
  if (enabled(frame_direct)) {
    float picks =
        random_number(uvec2(pixel), frame.sample_index, light_picks_dimension, frame.seed);
    terms.direct = direct_light(m, world_position(pixel, view_z), picks);
  }
  if (enabled(frame_indirect)) {
    terms.indirect = spread_albedo(m);
  } else if (enabled(frame_environment_diffuse)) {
    terms.ambient = environment_diffuse(m);
  }
  if (traces_specular(specular_roughness(m), max_roughness)) {
    terms.specular = specular_demodulator(m);
  } else if (enabled(frame_environment_specular)) {
    terms.ambient += environment_specular(m);
    if (enabled(frame_indirect)) terms.sky = luminance(open_indirect(m));
  }
  terms.ambient *= imageLoad(base_color, pixel).a;  // the occlusion texture
  return terms;
}

Composition pixel_composition(ivec2 pixel) {
  float view_z = imageLoad(motion, pixel).w;
  if (view_z <= 0.0) {
    return without_light(has_background != 0u ? imageLoad(background, pixel).rgb
                                              : environment_background(-to_eye(pixel)));
  }
  Composition terms;
  if (is_unlit(pixel)) {
    vec3 root = imageLoad(base_color, pixel).rgb;
    terms = without_light(root * root);
  } else {
    terms = lit_composition(pixel, view_z);
  }
  if (enabled(frame_emissive)) terms.own += imageLoad(emissive, pixel).rgb;
  return terms;
}

/// The frame's radiance from its signals. NaN must not spread through the history.
vec4 composed(Composition terms, vec2 visibility, vec3 specular, vec3 indirect) {
  float lit = enabled(frame_shadows) ? visibility.x : 1.0;
  float open = traces_ambient(frame.flags) ? visibility.y : 1.0;
  if (terms.sky > 0.0) open = min(luminance(indirect) / terms.sky, 1.0);
  vec3 radiance = terms.own + terms.direct * lit + terms.ambient * open +
                  terms.specular * specular + terms.indirect * indirect;
  if (any(isnan(radiance)) || any(isinf(radiance))) radiance = vec3(0.0);
  return vec4(radiance, 1.0);
}

/// `smooth_indirect`: where there is no sample.
vec4 composed_of_raw_signals(Composition terms, ivec2 pixel, vec3 smooth_indirect) {
  vec2 visibility =
      vec2(imageLoad(shadow_visibility, pixel).r, imageLoad(ambient_visibility, pixel).r);
  vec3 specular = max_roughness < 0.0 ? vec3(0.0) : imageLoad(specular_radiance, pixel).rgb;
  vec4 sampled = enabled(frame_indirect) ? imageLoad(indirect_radiance, pixel) : vec4(0.0);
  vec3 indirect = sampled.w < 0.0 ? smooth_indirect : sampled.rgb;
  return composed(terms, visibility, specular, indirect);
}

#endif
