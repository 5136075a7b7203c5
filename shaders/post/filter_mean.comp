#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Filters the accumulated mean of a static view by its own noise: non-local means (Buades et al.
// 2005) of its difference from the denoised frame, with the variance that its samples tell
// (Rousselle et al. 2012). Where patches of 3x3 pixels differ by no more than their noise, they
// weigh alike. Weights are symmetric, so that rare bright samples are spread and not lost. A pixel
// whose few samples happen to be alike is as noisy as its surroundings, not free of noise.
#include "lib/denoise/history_texels.glsl"
#include "lib/frame.glsl"
#include "lib/lighting/lights.glsl"
#include "shared/exposure.h"

layout(set = 1, binding = 0) uniform sampler2D radiance;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D accumulated;  // a: variance
layout(set = 1, binding = 2, std140) uniform ExposureBlock { ExposureState exposure; };
layout(set = 1, binding = 3, rgba16f) writeonly uniform image2D filtered;
layout(push_constant) uniform Constants {
  uvec2 shown;           // size of all images, pixels
  float variance_scale;  // of one sample's variance to the mean's
  float noise_scale;     // of the filtered mean's variance, as its weights tell it; 0: only a copy
  float prior_share;     // of the surroundings' variance, which a pixel's is at least
};

const int window = 3;  // pixels on either side that are averaged
const int patch_reach = 1;
const int reach = window + patch_reach;
const int side = 8 + 2 * reach;
const int surroundings = 4;  // pixels on either side whose variance is averaged
const int wide_side = side + 2 * surroundings;
const float least_noise = 1e-9;      // of exposed radiance
const float guide_weight = 75.0;     // of squared differences of the denoised frame

shared vec4 differences[side * side];  // of exposed radiance; a: variance of its luminance
shared vec2 luminances[side * side];   // luminance of the difference, and of the exposed frame
shared float variances[wide_side * wide_side];
shared float variance_rows[wide_side * side];  // their sums over the columns of the surroundings

/// From radiance to the exposed image, in which bright pixels differ less.
float unit_of(vec3 seen, vec3 mean) {
  return exposure.factor /
         (1.0 + 0.5 * exposure.factor * (luminance(seen) + luminance(mean)));
}

/// Of `at`, counted from the corner of the surroundings.
void prepare(ivec2 at, ivec2 pixel) {
  vec3 seen = texelFetch(radiance, pixel, 0).rgb;
  vec4 mean = imageLoad(accumulated, pixel);
  float unit = unit_of(seen, mean.rgb);
  vec4 difference = vec4((mean.rgb - seen) * unit, mean.a * variance_scale * unit * unit);
  // A number that is none must not spread.
  bool bad = any(isnan(difference)) || any(isinf(difference));
  variances[at.y * wide_side + at.x] = bad ? 0.0 : difference.a;
  ivec2 inner = at - surroundings;
  if (any(lessThan(inner, ivec2(0))) || any(greaterThanEqual(inner, ivec2(side)))) return;
  int i = inner.y * side + inner.x;
  differences[i] = bad ? vec4(0.0) : difference;
  luminances[i] = bad ? vec2(0.0) : vec2(luminance(difference.rgb), luminance(seen) * unit_of(seen, seen));
}

/// Variances are no less than the surroundings' share.
void raise_variances(ivec2 wide_corner, ivec2 last) {
  for (int i = int(gl_LocalInvocationIndex); i < wide_side * side; i += 64) {
    int x = clamp(wide_corner.x + surroundings + i % side, 0, last.x) - wide_corner.x;
    float sum = 0.0;
    for (int j = -surroundings; j <= surroundings; ++j) {
      sum += variances[i / side * wide_side + x + j];
    }
    variance_rows[i] = sum;
  }
  barrier();
  const int width = 2 * surroundings + 1;
  for (int i = int(gl_LocalInvocationIndex); i < side * side; i += 64) {
    int y = clamp(wide_corner.y + surroundings + i / side, 0, last.y) - wide_corner.y;
    float sum = 0.0;
    for (int j = -surroundings; j <= surroundings; ++j) sum += variance_rows[(y + j) * side + i % side];
    differences[i].a = max(differences[i].a, prior_share * sum / float(width * width));
  }
}

/// Squared difference of two pixels in units of what noise explains.
float apart(int a, int b) {
  vec2 difference = luminances[a] - luminances[b];
  float noise = differences[a].a + differences[b].a + least_noise;
  return difference.x * difference.x / noise + guide_weight * difference.y * difference.y;
}

/// The weight of the patch around `b` in the mean of those like the one around `a`: 1 within the
/// noise, 0 from twice as far.
float likeness(int a, int b) {
  float sum = 0.0;
  for (int y = -patch_reach; y <= patch_reach; ++y) {
    for (int x = -patch_reach; x <= patch_reach; ++x) {
      int offset = y * side + x;
      sum += apart(a + offset, b + offset);
    }
  }
  float like = clamp(2.0 - sum / 9.0, 0.0, 1.0);
  return like * like * like * like;
}

/// Where there is a number that is none, the frame is kept.
void keep(ivec2 pixel, vec3 seen, vec3 color, float variance) {
  vec4 texel = vec4(color, sqrt(variance));
  if (any(isnan(texel)) || any(isinf(texel))) texel = vec4(seen, 0.0);
  imageStore(filtered, pixel, nearest_halves(texel));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool inside = all(lessThan(uvec2(pixel), shown));
  if (noise_scale == 0.0) {
    if (!inside) return;
    vec4 mean = imageLoad(accumulated, pixel);
    keep(pixel, texelFetch(radiance, pixel, 0).rgb, mean.rgb, mean.a * variance_scale);
    return;
  }
  ivec2 wide_corner = ivec2(gl_WorkGroupID.xy) * 8 - reach - surroundings;
  ivec2 last = ivec2(shown) - 1;
  for (int i = int(gl_LocalInvocationIndex); i < wide_side * wide_side; i += 64) {
    ivec2 at = ivec2(i % wide_side, i / wide_side);
    prepare(at, clamp(wide_corner + at, ivec2(0), last));
  }
  barrier();
  raise_variances(wide_corner, last);
  barrier();
  if (!inside) return;
  ivec2 own = ivec2(gl_LocalInvocationID.xy) + reach;
  int center = own.y * side + own.x;
  vec3 sum = vec3(0.0);
  float weights = 0.0, squares = 0.0;
  for (int y = -window; y <= window; ++y) {
    for (int x = -window; x <= window; ++x) {
      int other = center + y * side + x;
      float weight = likeness(center, other);
      sum += differences[other].rgb * weight;
      weights += weight;
      squares += weight * weight;
    }
  }
  vec3 seen = texelFetch(radiance, pixel, 0).rgb;
  vec4 mean = imageLoad(accumulated, pixel);
  float unit = unit_of(seen, mean.rgb);
  float share = squares / (weights * weights);
  keep(pixel, seen, seen + sum / (weights * unit),
       max(differences[center].a / (unit * unit), mean.a * variance_scale) * noise_scale * share);
}
