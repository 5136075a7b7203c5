#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Temporal antialiasing as in Falcor: the history along the motion of surfaces, kept within mean
// and deviation of the 3x3 neighbours in YCgCo (Salvi 2016), read by Catmull-Rom's filter so that
// it does not blur with every frame, blended with less of the new frame where it lies close to the
// faces of that box.
#include "lib/frame.glsl"
#include "shared/exposure.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D hdr;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2) uniform sampler2D history;
layout(set = 1, binding = 3, std140) uniform ExposureBlock { ExposureState exposure; };
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D resolved;
layout(push_constant) uniform Constants {
  float blend;         // weight of the new frame
  float clip;          // half width of the box in standard deviations
  float anti_flicker;  // 1: on
};

// Least part of `blend` that anti-flicker leaves: a colour that was clamped to the face of the box
// would otherwise never change.
const float min_anti_flicker = 0.2;

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

/// Motion of the nearest surface of 3x3 pixels: an edge moves with what lies in front.
vec2 nearest_motion(ivec2 pixel) {
  ivec2 last = ivec2(frame.extent) - 1;
  ivec2 nearest = pixel;
  vec4 closest = vec4(0.0);
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
      vec4 candidate = imageLoad(motion, at);
      if (candidate.w <= 0.0 || (closest.w > 0.0 && candidate.w >= closest.w)) continue;
      closest = candidate;
    }
  }
  return closest.w > 0.0 ? closest.xy : background_motion(pixel);
}

/// Catmull-Rom's 16 texels as 9 bilinear fetches; may overshoot.
vec3 sample_history(vec2 uv) {
  vec2 size = vec2(frame.extent);
  vec2 position = uv * size;
  vec2 center = floor(position - 0.5) + 0.5;
  vec2 f = position - center;
  vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
  vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
  vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
  vec2 w3 = f * f * (-0.5 + 0.5 * f);
  vec2 w12 = w1 + w2;
  vec2 uv0 = (center - 1.0) / size;
  vec2 uv12 = (center + w2 / w12) / size;
  vec2 uv3 = (center + 2.0) / size;
  vec3 sum = textureLod(history, uv0, 0.0).rgb * (w0.x * w0.y);
  sum += textureLod(history, vec2(uv12.x, uv0.y), 0.0).rgb * (w12.x * w0.y);
  sum += textureLod(history, vec2(uv3.x, uv0.y), 0.0).rgb * (w3.x * w0.y);
  sum += textureLod(history, vec2(uv0.x, uv12.y), 0.0).rgb * (w0.x * w12.y);
  sum += textureLod(history, uv12, 0.0).rgb * (w12.x * w12.y);
  sum += textureLod(history, vec2(uv3.x, uv12.y), 0.0).rgb * (w3.x * w12.y);
  sum += textureLod(history, vec2(uv0.x, uv3.y), 0.0).rgb * (w0.x * w3.y);
  sum += textureLod(history, vec2(uv12.x, uv3.y), 0.0).rgb * (w12.x * w3.y);
  sum += textureLod(history, uv3, 0.0).rgb * (w3.x * w3.y);
  return max(sum, 0.0);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec4 center = imageLoad(hdr, pixel);
  vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.extent);
  vec2 before = uv + nearest_motion(pixel);
  // What was outside the previous frame has no history.
  bool known = frame.history_invalid == 0u && all(greaterThanEqual(before, vec2(0.0))) &&
               all(lessThanEqual(before, vec2(1.0)));
  if (!known) {
    imageStore(resolved, pixel, center);
    return;
  }

  ivec2 last = ivec2(frame.extent) - 1;
  vec3 nearby[9];
  vec3 mean = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    ivec2 at = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
    nearby[i] = compressed(imageLoad(hdr, at).rgb);
    mean += nearby[i] / 9.0;
  }
  // About the mean, not as a difference of squares: compressed highlights hardly differ.
  vec3 variance = vec3(0.0);
  for (int i = 0; i < 9; ++i) variance += (nearby[i] - mean) * (nearby[i] - mean) / 9.0;
  vec3 half_extent = clip * sqrt(variance);
  vec3 low = mean - half_extent;
  vec3 high = mean + half_extent;

  vec3 old = compressed(sample_history(before));
  float weight = blend;
  if (anti_flicker > 0.0) {
    float margin = min(abs(old.x - low.x), abs(high.x - old.x));
    weight *= max(margin / max(margin + high.x - low.x, 1e-6), min_anti_flicker);
  }
  vec3 blended = mix(clamp(old, low, high), compressed(center.rgb), clamp(weight, 0.0, 1.0));
  imageStore(resolved, pixel, vec4(expanded(blended), center.a));
}
