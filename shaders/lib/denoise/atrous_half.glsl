// Half of a separable iteration of the a-trous filter (paper section 3.3), across or down: as
// atrous.glsl, with taps along one axis, whose depths cost less to weigh, and variances of a group
// read once. GPUs are bound by what they read: keeping taps of both halves in shared memory took
// longer, since neighbouring groups then filter the same texels. What a signal is comes from the
// shader that includes this.
#include "lib/denoise/atrous_taps.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant) uniform Constants { AtrousConstants constants; };

const int group_side = 16;
const int side = group_side + 2;  // variance is smoothed over 3x3 texels
shared vec2 variances[side * side];

/// Of the texel at `at`, counted from the corner of what the group reads; beyond the border of the
/// images that of the nearest texel.
void read_variance(ivec2 at, ivec2 extent) {
  ivec2 texel = ivec2(gl_WorkGroupID.xy) * group_side - 1 + at;
  variances[at.y * side + at.x] =
      variance_of(imageLoad(signal, clamp(texel, ivec2(0), extent - 1)));
}

/// The group's own texels and those around them.
void read_variances(vec4 value, ivec2 extent) {
  ivec2 own = ivec2(gl_LocalInvocationID.xy) + 1;
  if (all(lessThan(ivec2(gl_GlobalInvocationID.xy), extent))) {
    variances[own.y * side + own.x] = variance_of(value);
  } else {
    read_variance(own, extent);
  }
  int border = int(gl_LocalInvocationIndex);  // its texels are read by as many threads
  if (border < 2 * side) {
    read_variance(ivec2(border % side, border < side ? 0 : side - 1), extent);
  } else if (border < 2 * (side + group_side)) {
    border -= 2 * side;
    read_variance(ivec2(border < group_side ? 0 : side - 1, border % group_side + 1), extent);
  }
  barrier();
}

/// As smooth_variance() of smooth_variance.glsl.
vec2 smoothed() {
  int middle = (int(gl_LocalInvocationID.y) + 1) * side + int(gl_LocalInvocationID.x) + 1;
  vec2 sum = vec2(0.0);
  for (int y = -1; y <= 1; ++y) {
    int i = middle + y * side;
    sum += float(2 - abs(y)) * (variances[i - 1] + 2.0 * variances[i] + variances[i + 1]);
  }
  return sum / 16.0;
}

struct Line {
  ivec2 middle;   // of the taps
  ivec2 axis;
  int step;
  float rise;          // of view Z per texel along the axis, metres
  float by_depth;      // weight of a depth off the plane, per texel of distance: depth_exponent()
  vec2 by_brightness;  // weight of its difference: luminance_exponent()
};

void add_tap(Center c, Line line, ivec2 extent, int number, float exponent, inout vec4 sum,
             inout vec2 total) {
  ivec2 tap = line.middle + number * line.step * line.axis;
  if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, extent))) return;
  vec4 guide_q = imageLoad(guide, tap);
  if (guide_is_background(guide_q)) return;
  vec4 value = imageLoad(signal, tap);
  Guide q = decode_guide(guide_q);
  float away = float(dot(tap - c.pixel, line.axis));
  float off = plane_distance(c.view_z, line.axis * line.rise, c.curve, q.view_z, tap - c.pixel);
  exponent += normal_exponent(dot(c.normal, q.normal), constants.normal_power) +
              signal_exponent(c.roughness, q.roughness) -
              off * min(line.by_depth / abs(away), 1e30);
  vec2 weight = edge_weight(exponent - abs(brightness(value) - c.brightness) * line.by_brightness);
  sum += spread(weight) * value;
  total += weight;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 extent = image_extent(constants);
  bool outside = any(greaterThanEqual(pixel, extent));
  vec4 value = outside ? vec4(0.0) : imageLoad(signal, pixel);
  vec2 variance = variance_of(value);
  if (has(constants, atrous_variance_prefilter)) {
    read_variances(value, extent);
    variance = smoothed();
  }
  if (outside) return;
  vec4 guide_p = imageLoad(guide, pixel);
  Guide p = decode_guide(guide_p);
  if (is_left(constants, guide_p, p)) {
    imageStore(filtered, pixel, value);
    return;
  }
  Center c = center_at(constants, pixel, p, value);
  vec2 noise = sqrt(max(variance, vec2(0.0)));  // standard deviation
  Line line;
  line.step = step_at(constants, c.roughness);
  line.middle = pixel + jitter(constants, pixel, line.step);
  line.axis = min(ivec2(constants.columns, constants.rows), ivec2(1));
  line.rise = dot(c.slope, vec2(line.axis));
  line.by_depth = 1.0 / (constants.depth_sigma * (abs(line.rise) + 0.5 * c.footprint));
  line.by_brightness = 1.0 / (constants.luminance_sigma * noise + smallest_difference);
  vec4 sum = value;
  vec2 total = vec2(1.0);
  add_tap(c, line, extent, -2, kernel_exponent[2], sum, total);
  add_tap(c, line, extent, -1, kernel_exponent[1], sum, total);
  add_tap(c, line, extent, 1, kernel_exponent[1], sum, total);
  add_tap(c, line, extent, 2, kernel_exponent[2], sum, total);
  imageStore(filtered, pixel, filtered_value(constants, value, sum, total));
}
