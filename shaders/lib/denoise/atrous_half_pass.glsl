// Half of a separable iteration of the a-trous filter (paper section 3.3), across or down: as
// atrous.glsl, with taps along one axis, whose depths cost less to weigh, and variances of a group
// read once. Keeping taps of both halves in shared memory took longer, since neighbouring groups
// then filter the same texels. So that taps read less, the guide is packed, and the signal holds
// 16 bits a channel between the passes of a blur. These passes are bound by instructions: what a
// tap need not work out is worked out once a pixel, and what is read is bound as textures, whose
// unit turns 16 bits into floats. What a `Value` is, what `Channels` of it have weights of their
// own, and the images come from atrous_half.glsl or atrous_half_pair.glsl.
#include "lib/denoise/packed_guide.glsl"

const int group_side = 16;
const int side = group_side + 2;  // variance is smoothed over 3x3 texels
shared Channels variances[side * side];

/// Of a texel as it lies in the image: in 16 bits standard deviations stand in place of variances,
/// which leave their range.
Value decoded(Value texel) {
#ifdef SIGNAL_IN_FLOATS
  return texel;
#else
  Channels deviation = variance_of(texel);
  return with_variance(texel, deviation * deviation);
#endif
}

Value signal_at(ivec2 texel) { return decoded(load(texel)); }

/// Likewise of a texel as it lies in the image. Variances take the square of the weight.
Value weighed_texel(Value texel, Channels weight) {
  Value part = weighed(texel, weight);
#ifdef SIGNAL_IN_FLOATS
  return with_variance(part, variance_of(part) * weight);
#else
  return decoded(part);
#endif
}

void store(ivec2 texel, Value value) {
#if !defined(FILTERED_IN_FLOATS) && !defined(FILTERED_IS_RESULT)
  value = with_variance(value, sqrt(max(variance_of(value), Channels(0.0))));
#endif
#ifndef FILTERED_IN_FLOATS
  value = nearest_halves(value);
#endif
  save(texel, value);
}

/// Of the texel at `at`, counted from the corner of what the group reads; beyond the border of the
/// images that of the nearest texel.
void read_variance(ivec2 at, ivec2 extent) {
  ivec2 texel = ivec2(gl_WorkGroupID.xy) * group_side - 1 + at;
  variances[at.y * side + at.x] = variance_of(signal_at(clamp(texel, ivec2(0), extent - 1)));
}

/// The group's own texels, which have `variance`, and those around them.
void read_variances(Channels variance, ivec2 extent) {
  ivec2 own = ivec2(gl_LocalInvocationID.xy) + 1;
  variances[own.y * side + own.x] = variance;
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
Channels smoothed() {
  int middle = (int(gl_LocalInvocationID.y) + 1) * side + int(gl_LocalInvocationID.x) + 1;
  Channels sum = Channels(0.0);
  for (int y = -1; y <= 1; ++y) {
    int i = middle + y * side;
    sum += float(2 - abs(y)) * (variances[i - 1] + 2.0 * variances[i] + variances[i + 1]);
  }
  return sum / 16.0;
}

/// What the taps of a pixel have in common. Parts of exponents count in bits of the weight:
/// bits_per_exponent.
struct Line {
  ivec2 middle;            // of the taps
  ivec2 stride;            // from tap to tap
  int at;                  // where the middle is along the axis
  int end;                 // of the image along the axis
  int step;                // from tap to tap, texels
  float shift;             // of the middle from the pixel, texels
  vec3 normal;             // of the pixel, as its roughness and view Z
  float roughness;
  float view_z;
  float bend;              // of the pixel's plane per texel, in parts of the tap's view Z
  float tilt;              // of the plane per texel besides, metres
  float by_normal;         // normal_power
  float by_depth;          // depth_exponent() of a rise off the plane
  float by_roughness;      // roughness_exponent()
  Channels by_brightness;  // luminance_exponent()
  Channels brightness;     // of the pixel
};

/// plane_distance() per texel of distance, as are by_depth and the plane's rise.
void set_depth(inout Line line, Center c, float rise) {
  line.view_z = c.view_z;
  line.bend = rise * c.curve;
  line.tilt = rise * (1.0 - c.view_z * c.curve);
  float allowance = constants.depth_sigma * (abs(rise) + 0.5 * c.footprint);
  line.by_depth = min(1.0 / allowance, 1e30) * bits_per_exponent;
}

Line line_of(Center c, Value value, Channels variance, ivec2 extent) {
  Channels noise = sqrt(max(variance, Channels(0.0)));  // standard deviation
  ivec2 axis = min(ivec2(constants.columns, constants.rows), ivec2(1));
  Line line;
  line.step = step_at(constants, c.roughness);
  line.stride = line.step * axis;
  ivec2 shift = jitter(constants, c.pixel, line.step);
  line.middle = c.pixel + shift;
  line.at = axis.x != 0 ? line.middle.x : line.middle.y;
  line.end = axis.x != 0 ? extent.x : extent.y;
  line.shift = float(shift.x + shift.y);
  line.normal = c.normal;
  line.roughness = c.roughness;
  set_depth(line, c, dot(c.slope, vec2(axis)));
  line.by_normal = constants.normal_power * bits_per_exponent;
  line.by_roughness = roughness_falloff(c.roughness) * bits_per_exponent;
  line.by_brightness = bits_per_exponent / (luminance_sigmas() * noise + smallest_difference);
  line.brightness = brightness(value);
  return line;
}

/// Bits of the weight of a tap `distance` texels away, on account of its surface: for all signals,
/// and what a difference in roughness adds.
vec2 surface_bits(Line line, uvec2 guide_q, float distance, float exponent) {
  vec3 toward = packed_direction(guide_q);
  float cosine = dot(line.normal, toward) * inversesqrt(dot(toward, toward));
  float z = packed_view_z(guide_q);
  float off = abs((z - line.view_z) / distance - (z * line.bend + line.tilt));
  float bits = bits_of_one + exponent * bits_per_exponent + line.by_normal * (cosine - 1.0);
  return vec2(bits - off * line.by_depth,
              -abs(packed_roughness(guide_q) - line.roughness) * line.by_roughness);
}

/// Across the axis taps are within the image as the pixel is. None is the pixel itself: jitter is
/// less than half of a step.
void add_tap(Line line, int number, float exponent, inout Value sum, inout Channels total) {
  if (uint(line.at + number * line.step) >= uint(line.end)) return;
  ivec2 tap = line.middle + number * line.stride;
  uvec2 guide_q = texelFetch(guide, tap, 0).xy;
  if (is_background(guide_q)) return;
  Value texel = load(tap);
  vec2 bits = surface_bits(line, guide_q, float(number) * float(line.step) + line.shift, exponent);
  Channels weight =
      weight_of_bits(signal_exponent(bits.x, bits.y) -
                     abs(brightness(texel) - line.brightness) * line.by_brightness);
  sum = plus(sum, weighed_texel(texel, weight));
  total += weight;
}

Value filtered_value(Line line, Value value) {
  Value sum = value;
  Channels total = Channels(1.0);
  add_tap(line, -2, kernel_exponent[2], sum, total);
  add_tap(line, -1, kernel_exponent[1], sum, total);
  add_tap(line, 1, kernel_exponent[1], sum, total);
  add_tap(line, 2, kernel_exponent[2], sum, total);
  Channels share = 1.0 / total;
  Channels variance = variance_of(sum) * share * share;
  return with_variance(weighed(sum, share), mix(variance, variance_of(value), keep_variance()));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 extent = image_extent(constants);
  bool outside = any(greaterThanEqual(pixel, extent));
  Value value = signal_at(min(pixel, extent - 1));  // outside it serves neighbours' variance
  Channels variance = variance_of(value);
  if (has(constants, atrous_variance_prefilter)) {
    read_variances(variance, extent);
    variance = smoothed();
  }
  if (outside) return;
  Guide p = unpack_guide(texelFetch(guide, pixel, 0).xy);
  if (all_left(p)) {
    store(pixel, value);
    return;
  }
  vec2 slope = unpack_slope(texelFetch(depth_slope, pixel, 0), p.view_z);
  Line line = line_of(center_at(constants, pixel, p, slope), value, variance, extent);
  store(pixel, where_left(p, value, filtered_value(line, value)));
}
