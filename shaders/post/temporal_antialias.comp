#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
// Temporal antialiasing: the mean of the samples of a pixel along the motion of surfaces, kept
// within mean and deviation of the 3x3 neighbours in YCgCo (Salvi 2016). A jittered sample of a
// pixel is one of the pixel's whole area; it is not filtered again. What blurs is reading the
// history between its texels, frame after frame: a cubic steeper than Catmull-Rom's makes up for it.
// Of a frame that is drawn smaller than it is shown, each pixel takes the nearest sample, by its
// distance from the pixel's centre: the structure of Snapdragon GSR 2. What neighbours have in
// common is read once for a group.
#include "lib/denoise/history_texels.glsl"
#include "lib/frame.glsl"
#include "shared/exposure.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D hdr;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2) uniform sampler2D history;
layout(set = 1, binding = 3, std140) uniform ExposureBlock { ExposureState exposure; };
layout(set = 1, binding = 4, rgba16f) writeonly uniform image2D resolved;  // a: samples
layout(push_constant) uniform Constants {
  uvec2 shown;         // size of the history and the result, pixels
  float blend;         // least weight of the new frame
  float clip;          // half width of the box in standard deviations
  float anti_flicker;  // 1: on
  uint hold;           // 1: the history is the result, as in a static view that is path traced
  uint has_settled;    // 1: nothing has moved in so many frames that the result hardly changes
};

// Least part of `blend` that anti-flicker leaves: a colour that was clamped to the face of the box
// would otherwise never change.
const float min_anti_flicker = 0.2;
// A surface this much nearer than the pixel's own, in parts of its distance, covers some of it.
const float edge_depth = 0.05;
// Slope of the cubic at its first zero; Catmull-Rom's is -0.5.
// TemporalAntialiasTest.SubpixelMotionKeepsDetail pins it.
const float cubic_slope = -0.75;
// What is read at a texel does not blur: so many times the frames may count there, falling to one
// in steps of 1 / off_texel_slope pixels.
const float most_still = 4.0;
const float off_texel_slope = 8.0;
// Fitted by similarity at 0.5 to 0.8 of the size: how fast a sample's weight falls with its distance
// in pixels, and how much wider the box is about neighbours that lie farther apart.
const float distance_falloff = 2.0;
const float scaled_box = 1.3;

const int group_side = 16;
// Samples are no farther apart than the pixels that take them; each reads those about its own.
const int side = group_side + 2;
shared vec3 colors[side * side];   // compressed()
shared vec3 motions[side * side];  // z: view Z

vec3 ycgco_from_rgb(vec3 c) {
  return vec3(dot(c, vec3(0.25, 0.5, 0.25)), dot(c, vec3(-0.25, 0.5, -0.25)),
              dot(c, vec3(0.5, 0.0, -0.5)));
}

vec3 rgb_from_ycgco(vec3 c) {
  float base = c.x - c.y;
  return vec3(base + c.z, c.x + c.y, base - c.z);
}

/// Bright colours weigh less, by their luma as shown, so that one firefly does not outweigh all
/// that surrounds it (Karis 2014): everything is compared and blended after this.
vec3 compressed(vec3 radiance) {
  vec3 c = ycgco_from_rgb(radiance * exposure.factor);
  return c / (1.0 + c.x);
}

vec3 expanded(vec3 c) {
  vec3 shown = c / max(1.0 - c.x, 1e-6);
  return max(rgb_from_ycgco(shown), 0.0) / exposure.factor;
}

/// Motion of the background under the camera's rotation; to the previous frame, in uv.
vec2 background_motion(ivec2 pixel) {
  if (enabled(frame_orthographic)) return vec2(0.0);
  vec4 direction = vec4(-to_eye(pixel), 0.0);
  vec4 before = frame.previous_unjittered * direction;
  vec4 now = frame.unjittered * direction;
  // Directions behind the camera have no position in the frame.
  if (before.w <= 0.0) return vec2(2.0);
  return (before.xy / before.w - now.xy / now.w) * 0.5;
}

/// What the group reads of the frame, from `corner` on; beyond the border that of the nearest
/// pixel.
void read_tile(ivec2 corner) {
  ivec2 last = ivec2(frame.extent) - 1;
  for (int i = int(gl_LocalInvocationIndex); i < side * side; i += group_side * group_side) {
    ivec2 at = clamp(corner + ivec2(i % side, i / side), ivec2(0), last);
    colors[i] = compressed(imageLoad(hdr, at).rgb);
    motions[i] = imageLoad(motion, at).xyw;
  }
  barrier();
}

/// Motion of the nearest surface of 3x3 pixels about `middle` of the tile: an edge moves with what
/// lies in front. Elsewhere that of the pixel itself: its neighbours on the same surface move by
/// more or less.
vec2 edge_motion(ivec2 pixel, int middle) {
  vec3 own = motions[middle];
  vec3 closest = own;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      vec3 candidate = motions[middle + y * side + x];
      if (candidate.z <= 0.0 || (closest.z > 0.0 && candidate.z >= closest.z)) continue;
      closest = candidate;
    }
  }
  if (closest.z <= 0.0) return background_motion(pixel);
  bool edge = own.z <= 0.0 || own.z - closest.z > edge_depth * closest.z;
  return edge ? closest.xy : own.xy;
}

/// Weights of four texels in a row for a point at fraction `f` between the second and the third.
vec4 cubic_weights(float f) {
  vec4 x = vec4(1.0 + f, f, 1.0 - f, 2.0 - f);
  vec2 near = ((cubic_slope + 2.0) * x.yz - (cubic_slope + 3.0)) * x.yz * x.yz + 1.0;
  vec2 far = cubic_slope * (((x.xw - 5.0) * x.xw + 8.0) * x.xw - 4.0);
  return vec4(far.x, near, far.y);
}

/// How far from a texel the history is read, 0 (there) to 0.5, along the farther axis.
float off_texel(vec2 uv) {
  vec2 off = abs(fract(uv * vec2(shown)) - 0.5);
  return max(off.x, off.y);
}

/// May overshoot; a: of the nearest texel.
vec4 sample_history(vec2 uv) {
  vec2 position = uv * vec2(shown) - 0.5;
  ivec2 first = ivec2(floor(position)), last = ivec2(shown) - 1;
  vec2 f = position - vec2(first);
  vec4 across = cubic_weights(f.x), down = cubic_weights(f.y);
  ivec2 nearest = 1 + ivec2(greaterThanEqual(f, vec2(0.5)));
  float samples = 0.0;
  vec3 sum = vec3(0.0);
  for (int y = 0; y < 4; ++y) {
    vec3 line = vec3(0.0);
    for (int x = 0; x < 4; ++x) {
      ivec2 at = clamp(first + ivec2(x, y) - 1, ivec2(0), last);
      vec4 texel = texelFetch(history, at, 0);
      line += texel.rgb * across[x];
      if (ivec2(x, y) == nearest) samples = texel.a;
    }
    sum += line * down[y];
  }
  return vec4(max(sum, 0.0), samples);
}

struct Sample {
  ivec2 pixel;   // that was drawn
  float weight;  // 1 at the centre of the pixel that is shown
};

/// The nearest sample.
Sample nearest_sample(ivec2 pixel) {
  if (shown == frame.extent) return Sample(pixel, 1.0);
  vec2 scale = vec2(frame.extent) / vec2(shown);
  vec2 center = (vec2(pixel) + 0.5) * scale;
  vec2 jitter = -0.5 * frame.unproject.zw / frame.unproject.xy * vec2(frame.extent);
  ivec2 at = clamp(ivec2(floor(center + jitter)), ivec2(0), ivec2(frame.extent) - 1);
  vec2 off = (vec2(at) + 0.5 - jitter - center) / scale;
  float far = distance_falloff * dot(off, off);
  return Sample(at, 1.0 / (1.0 + far + 0.5 * far * far));
}

/// In turn, so that rounding does not hold up the mean. Once that has settled it would flicker.
void keep(ivec2 pixel, vec4 texel) {
  texel = has_settled != 0u ? nearest_halves(texel)
                          : as_halves(texel, rounding_of(pixel, frame.sample_index));
  imageStore(resolved, pixel, texel);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool outside = any(greaterThanEqual(uvec2(pixel), shown));
  if (hold != 0u) {
    if (!outside) imageStore(resolved, pixel, texelFetch(history, pixel, 0));
    return;
  }
  ivec2 corner = nearest_sample(ivec2(gl_WorkGroupID.xy) * group_side).pixel - 1;
  read_tile(corner);
  if (outside) return;
  Sample found = nearest_sample(pixel);
  // Where rounding decides between two samples, one that the tile holds.
  ivec2 place = min(found.pixel - corner, ivec2(group_side));
  int middle = place.y * side + place.x;
  vec2 uv = (vec2(pixel) + 0.5) / vec2(shown);
  vec2 before = uv + edge_motion(found.pixel, middle);
  // What was outside the previous frame has no history.
  bool known = frame.history_invalid == 0u && all(greaterThanEqual(before, vec2(0.0))) &&
               all(lessThanEqual(before, vec2(1.0)));
  if (!known) {
    keep(pixel, vec4(imageLoad(hdr, found.pixel).rgb, found.weight));
    return;
  }

  vec3 nearby[9];
  vec3 mean = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    nearby[i] = colors[middle + (i / 3 - 1) * side + i % 3 - 1];
    mean += nearby[i] / 9.0;
  }
  // About the mean, not as a difference of squares: compressed highlights hardly differ.
  vec3 variance = vec3(0.0);
  for (int i = 0; i < 9; ++i) variance += (nearby[i] - mean) * (nearby[i] - mean) / 9.0;
  vec3 half_extent = (shown == frame.extent ? clip : scaled_box * clip) * sqrt(variance);
  vec3 low = mean - half_extent;
  vec3 high = mean + half_extent;

  vec4 history_before = sample_history(before);
  vec3 old = compressed(history_before.rgb);
  float still = max(1.0 - off_texel_slope * off_texel(before), 0.0);
  vec2 scale = vec2(frame.extent) / vec2(shown);
  float most = (1.0 / blend - 1.0) * mix(1.0, most_still, still) * scale.x * scale.y;
  float samples = min(history_before.a, most) + found.weight;
  float weight = found.weight / samples;
  if (anti_flicker > 0.0) {
    float margin = min(abs(old.x - low.x), abs(high.x - old.x));
    weight *= max(margin / max(margin + high.x - low.x, 1e-6), min_anti_flicker);
  }
  vec3 blended = mix(clamp(old, low, high), nearby[4], weight);
  keep(pixel, vec4(expanded(blended), samples));
}
