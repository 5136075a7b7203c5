// Pixels and taps of the edge-avoiding a-trous wavelet filter (Dammertz et al. 2010), which is
// guided by variance (Schied et al. 2017, equations 1 to 5), whatever the signal.
#ifndef HELIOGRAPH_DENOISE_ATROUS_TAPS_GLSL
#define HELIOGRAPH_DENOISE_ATROUS_TAPS_GLSL
#include "lib/denoise/edge_stopping.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/frame.glsl"
#include "lib/math/random.glsl"
#include "shared/denoise.h"

/// Of the B3 spline (1, 4, 6, 4, 1) / 16 against its middle: logarithms of 1, 2/3 and 1/6.
const float kernel_exponent[3] = float[3](0.0, -0.40546511, -1.79175947);

bool has(AtrousConstants constants, uint flag) { return (constants.flags & flag) != 0u; }

struct Center {
  ivec2 pixel;
  vec3 normal;
  float roughness;
  float view_z;
  vec2 slope;
  float curve;
  float footprint;
};

/// `slope`: change of view Z from texel to texel.
Center center_at(AtrousConstants constants, ivec2 pixel, Guide p, vec2 slope) {
  Center c;
  c.pixel = pixel;
  c.normal = p.normal;
  c.roughness = p.roughness;
  c.view_z = p.view_z;
  c.slope = slope;
  c.curve = enabled(frame_orthographic) ? 0.0 : 1.0 / c.view_z;
  c.footprint = pixel_footprint(c.view_z) * float(constants.pixels_per_texel);
  return c;
}

/// Of the images, which may be smaller than the frame.
ivec2 image_extent(AtrousConstants constants) {
  return (ivec2(frame.extent) + constants.pixels_per_texel - 1) / constants.pixels_per_texel;
}

/// How often a pixel is filtered: not beyond the width of the lobe, and less often where
/// reflections bring no noise of their own (paper 3.5).
int levels(AtrousConstants constants, float roughness) {
  int most = 16;
  if (has(constants, atrous_lobe_limit)) {
    float pixels = lobe_pixels(roughness);
    most = pixels < 1.0 ? 0 : 1 + int(log2(pixels));
  }
  if (!has(constants, atrous_levels_by_roughness)) return most;
  if (roughness <= atrous_unblurred_roughness) return 0;
  return roughness <= atrous_blurred_once_roughness ? min(most, 1) : most;
}

/// Whether this iteration leaves the pixel as it is.
bool is_left(AtrousConstants constants, Guide p) {
  return p.view_z <= 0.0 || constants.level >= levels(constants, p.roughness);
}

/// Pixels from tap to tap: twice as many on surfaces rougher than the threshold, with a band
/// between, so that textured roughness does not show the border.
int step_at(AtrousConstants constants, float roughness) {
  float twice = smoothstep(constants.start_threshold - atrous_step_half_band,
                           constants.start_threshold + atrous_step_half_band, roughness);
  return int(round(float(1 << constants.level) * (1.0 + twice)));
}

/// Jitters the taps of large steps by up to a quarter step along the kernel, differently in every
/// row and frame. Whole rows move together, so that neighbours read neighbours.
ivec2 jitter(AtrousConstants constants, ivec2 pixel, int step) {
  if (!has(constants, atrous_jitter) || step <= 4) return ivec2(0);
  vec2 u = random_pair(uvec2(0, pixel.y), frame.sample_index, 48u + uint(constants.level),
                       frame.seed);
  ivec2 axes = min(ivec2(constants.columns, constants.rows), ivec2(1));
  return axes * ivec2(round((u - 0.5) * 0.5 * float(step)));
}

#endif
