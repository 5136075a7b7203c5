// Half of a separable iteration of the a-trous filter (paper section 3.3), across or down: as
// atrous.glsl, with taps along one axis, whose depths cost less to weigh, and variances of a group
// read once. Keeping taps of both halves in shared memory took longer, since neighbouring groups
// then filter the same texels. So that taps read less, the guide is packed, and the signal holds
// 16 bits a channel between the passes of a blur. What a signal is comes from the
// shader that includes this. It defines SIGNAL_IN_FLOATS where it reads what is blurred, and
// FILTERED_IN_FLOATS where it writes the result: these hold 32 bits.
#include "lib/denoise/atrous_taps.glsl"
#include "lib/denoise/packed_guide.glsl"

#ifdef SIGNAL_IN_FLOATS
#define SIGNAL_FORMAT rgba32f
#else
#define SIGNAL_FORMAT rgba16f
#endif
#ifdef FILTERED_IN_FLOATS
#define FILTERED_FORMAT rgba32f
#else
#define FILTERED_FORMAT rgba16f
#endif

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 1, binding = 0, rg32ui) readonly uniform uimage2D guide;
layout(set = 1, binding = 1, rg16f) readonly uniform image2D depth_slope;  // in parts of view Z
layout(set = 1, binding = 2, SIGNAL_FORMAT) readonly uniform image2D signal;
layout(set = 1, binding = 3, FILTERED_FORMAT) writeonly uniform image2D filtered;
layout(push_constant) uniform Constants { AtrousConstants constants; };

const int group_side = 16;
const int side = group_side + 2;  // variance is smoothed over 3x3 texels
shared vec2 variances[side * side];

/// In 16 bits standard deviations stand in place of variances, which leave their range.
vec4 signal_at(ivec2 texel) {
  vec4 value = imageLoad(signal, texel);
#ifndef SIGNAL_IN_FLOATS
  vec2 deviation = variance_of(value);
  value = with_variance(value, deviation * deviation);
#endif
  return value;
}

void store(ivec2 texel, vec4 value) {
#ifndef FILTERED_IN_FLOATS
  value = nearest_halves(with_variance(value, sqrt(max(variance_of(value), vec2(0.0)))));
#endif
  imageStore(filtered, texel, value);
}

/// Of the texel at `at`, counted from the corner of what the group reads; beyond the border of the
/// images that of the nearest texel.
void read_variance(ivec2 at, ivec2 extent) {
  ivec2 texel = ivec2(gl_WorkGroupID.xy) * group_side - 1 + at;
  variances[at.y * side + at.x] = variance_of(signal_at(clamp(texel, ivec2(0), extent - 1)));
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
  uvec2 guide_q = imageLoad(guide, tap).xy;
  if (is_background(guide_q)) return;
  vec4 value = signal_at(tap);
  Guide q = unpack_guide(guide_q);
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
  vec4 value = outside ? vec4(0.0) : signal_at(pixel);
  vec2 variance = variance_of(value);
  if (has(constants, atrous_variance_prefilter)) {
    read_variances(value, extent);
    variance = smoothed();
  }
  if (outside) return;
  Guide p = unpack_guide(imageLoad(guide, pixel).xy);
  if (is_left(constants, p)) {
    store(pixel, value);
    return;
  }
  vec2 slope = unpack_slope(imageLoad(depth_slope, pixel), p.view_z);
  Center c = center_at(constants, pixel, p, slope, value);
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
  store(pixel, filtered_value(constants, value, sum, total));
}
