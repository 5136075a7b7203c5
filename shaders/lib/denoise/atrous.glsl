// One iteration of the a-trous filter in any shape of kernel: 5 x 5, or 5 across and 5 down (paper
// section 3.3). What a signal is comes from the shader that includes this.
#include "lib/denoise/atrous_taps.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 0, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 1, rg32f) readonly uniform image2D depth_slope;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D signal;
layout(set = 1, binding = 3, rgba32f) writeonly uniform image2D filtered;
layout(push_constant) uniform Constants { AtrousConstants constants; };
#include "lib/denoise/smooth_variance.glsl"

/// `of_center`: its brightness. `noise`: standard deviation there.
vec2 tap_exponent(Center c, vec2 of_center, vec2 noise, Guide q, vec4 value, vec2 offset) {
  float common_part =
      depth_exponent(plane_distance(c.view_z, c.slope, c.curve, q.view_z, offset),
                     depth_allowance(c.slope, offset, c.footprint), constants.depth_sigma) +
      normal_exponent(dot(c.normal, q.normal), constants.normal_power);
  return signal_exponent(common_part, roughness_exponent(c.roughness, q.roughness)) +
         luminance_exponent(of_center, brightness(value), noise, constants.luminance_sigma,
                            smallest_difference);
}

/// Of weighed taps, the pixel's own `value` among them.
vec4 filtered_value(vec4 value, vec4 sum, vec2 total) {
  vec4 result = sum / spread(total);
  return has(constants, atrous_keep_variance) ? with_variance(result, variance_of(value)) : result;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 extent = image_extent(constants);
  if (any(greaterThanEqual(pixel, extent))) return;
  vec4 value = imageLoad(signal, pixel);
  Guide p = decode_guide(imageLoad(guide, pixel));
  if (is_left(constants, p)) {
    imageStore(filtered, pixel, value);
    return;
  }
  Center c = center_at(constants, pixel, p, imageLoad(depth_slope, pixel).xy);
  vec2 variance = has(constants, atrous_variance_prefilter) ? smooth_variance(pixel, extent)
                                                            : variance_of(value);
  vec2 noise = sqrt(max(variance, vec2(0.0)));  // standard deviation

  int step = step_at(constants, c.roughness);
  ivec2 shift = jitter(constants, pixel, step);
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
      vec2 weight =
          edge_weight(kernel_exponent[abs(x)] + kernel_exponent[abs(y)] +
                      tap_exponent(c, brightness(value), noise, decode_guide(guide_q), value_q,
                                   vec2(tap - pixel)));
      sum += spread(weight) * value_q;
      total += weight;
    }
  }
  imageStore(filtered, pixel, filtered_value(value, sum, total));
}
