// One iteration of the edge-avoiding a-trous wavelet filter (Dammertz et al. 2010), guided by
// variance (Schied et al. 2017, equations 1 to 5), in any shape of kernel: 5 x 5, or 5 across and 5
// down (paper section 3.3). What a signal is comes from the shader that includes this.
#include "lib/denoise/edge_stopping.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/frame.glsl"
#include "lib/math/random.glsl"
#include "shared/denoise.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 0, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 1, rg32f) readonly uniform image2D depth_slope;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D signal;
layout(set = 1, binding = 3, rgba32f) writeonly uniform image2D filtered;
layout(push_constant) uniform Constants { AtrousConstants constants; };
#include "lib/denoise/smooth_variance.glsl"

/// Of the B3 spline (1, 4, 6, 4, 1) / 16 against its middle: logarithms of 1, 2/3 and 1/6.
const float kernel_exponent[3] = float[3](0.0, -0.40546511, -1.79175947);

bool has(uint flag) { return (constants.flags & flag) != 0u; }

struct Center {
  ivec2 pixel;
  vec3 normal;
  float roughness;
  float view_z;
  vec2 slope;
  float curve;
  float footprint;
  vec2 brightness;
  vec2 noise;  // standard deviation
};

/// Of the images, which may be smaller than the frame.
ivec2 image_extent() {
  return (ivec2(frame.extent) + constants.pixels_per_texel - 1) / constants.pixels_per_texel;
}

/// How often a pixel is filtered: not beyond the width of the lobe, and less often where
/// reflections bring no noise of their own (paper 3.5).
int levels(float roughness) {
  int most = 16;
  if (has(atrous_lobe_limit)) {
    float pixels = lobe_pixels(roughness);
    most = pixels < 1.0 ? 0 : 1 + int(log2(pixels));
  }
  if (!has(atrous_levels_by_roughness)) return most;
  if (roughness <= atrous_unblurred_roughness) return 0;
  return roughness <= atrous_blurred_once_roughness ? min(most, 1) : most;
}

/// Pixels from tap to tap: twice as many on surfaces rougher than the threshold, with a band
/// between, so that textured roughness does not show the border.
int step_at(float roughness) {
  float twice = smoothstep(constants.start_threshold - atrous_step_half_band,
                           constants.start_threshold + atrous_step_half_band, roughness);
  return int(round(float(1 << constants.level) * (1.0 + twice)));
}

/// Jitters the taps of large steps by up to a quarter step along the kernel, differently in every
/// row and frame. Whole rows move together, so that neighbours read neighbours.
ivec2 jitter(ivec2 pixel, int step) {
  if (!has(atrous_jitter) || step <= 4) return ivec2(0);
  vec2 u = random_pair(uvec2(0, pixel.y), frame.sample_index, 48u + uint(constants.level),
                       frame.seed);
  ivec2 axes = min(ivec2(constants.columns, constants.rows), ivec2(1));
  return axes * ivec2(round((u - 0.5) * 0.5 * float(step)));
}

vec2 tap_exponent(Center c, Guide q, vec4 value, vec2 offset) {
  float shared_exponent =
      depth_exponent(plane_distance(c.view_z, c.slope, c.curve, q.view_z, offset),
                     depth_allowance(c.slope, offset, c.footprint), constants.depth_sigma) +
      normal_exponent(dot(c.normal, q.normal), constants.normal_power) +
      signal_exponent(c.roughness, q.roughness);
  return shared_exponent + luminance_exponent(c.brightness, brightness(value), c.noise,
                                              constants.luminance_sigma, smallest_difference);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 extent = image_extent();
  if (any(greaterThanEqual(pixel, extent))) return;
  vec4 value = imageLoad(signal, pixel);
  vec4 guide_p = imageLoad(guide, pixel);
  Guide p = decode_guide(guide_p);
  if (guide_is_background(guide_p) || constants.level >= levels(p.roughness)) {
    imageStore(filtered, pixel, value);
    return;
  }
  Center c;
  c.pixel = pixel;
  c.normal = p.normal;
  c.roughness = p.roughness;
  c.view_z = p.view_z;
  c.slope = imageLoad(depth_slope, pixel).xy;
  c.curve = enabled(frame_orthographic) ? 0.0 : 1.0 / c.view_z;
  c.footprint = pixel_footprint(c.view_z) * float(constants.pixels_per_texel);
  c.brightness = brightness(value);
  vec2 variance = has(atrous_variance_prefilter) ? smooth_variance(pixel, extent) : variance_of(value);
  c.noise = sqrt(max(variance, vec2(0.0)));

  int step = step_at(c.roughness);
  ivec2 shift = jitter(pixel, step);
  vec4 sum = value;
  vec2 total = vec2(1.0);
  for (int y = -constants.rows; y <= constants.rows; ++y) {
    for (int x = -constants.columns; x <= constants.columns; ++x) {
      ivec2 tap = pixel + ivec2(x, y) * step + shift;
      if (x == 0 && y == 0) continue;
      if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, extent))) continue;
      vec4 guide_q = imageLoad(guide, tap);
      if (guide_is_background(guide_q)) continue;
      vec4 value_q = imageLoad(signal, tap);
      vec2 weight = edge_weight(kernel_exponent[abs(x)] + kernel_exponent[abs(y)] +
                                tap_exponent(c, decode_guide(guide_q), value_q, vec2(tap - pixel)));
      sum += spread(weight) * value_q;
      total += weight;
    }
  }
  vec4 result = sum / spread(total);
  if (has(atrous_keep_variance)) result = with_variance(result, variance_of(value));
  imageStore(filtered, pixel, result);
}
