#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Temporal accumulation of visibility (Schied et al. 2017, section 4.2), shadow and ambient
// together.
#include "lib/frame.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/denoise/history_texels.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/denoise/rectification.glsl"
#include "lib/denoise/reprojection.glsl"

layout(set = 1, binding = 0) uniform sampler2D raw;  // shadow x, ambient y (0 where none is traced)
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D reprojection;
layout(set = 1, binding = 3, rgba16) readonly uniform image2D previous_signal;
layout(set = 1, binding = 4, rgba16) readonly uniform image2D previous_moments;
layout(set = 1, binding = 5, rgba16f) readonly uniform image2D previous_history;
layout(set = 1, binding = 6, rg16f) readonly uniform image2D previous_fast;
layout(set = 1, binding = 7) uniform sampler2D percentiles;  // of tiles, or anything
layout(set = 1, binding = 8, rgba32f) writeonly uniform image2D signal;   // value xy, variance zw
layout(set = 1, binding = 9, rgba16) writeonly uniform image2D kept;     // the same
layout(set = 1, binding = 10, rgba16) writeonly uniform image2D moments;  // first xy, second zw
layout(set = 1, binding = 11, rgba16f) writeonly uniform image2D history;  // frames xy, moved zw
layout(set = 1, binding = 12, rg16f) writeonly uniform image2D fast;  // or the change, for gradient
layout(push_constant) uniform Constants { TemporalConstants constants; };

#include "lib/denoise/percentile_tiles.glsl"

const float fast_frames = 6.0;

struct HistorySample {
  vec2 signal;
  vec4 moments;
  vec2 frames;  // 0: nothing
  vec2 fast;
};

/// The history between pixels, without the blur of bilinear weights. Clamped to the four nearest
/// pixels: a cubic overshoots at edges, and farther pixels may show other surfaces.
vec2 fetch_history_bicubic(HistoryTaps taps) {
  vec4 across = cubic_weights(taps.fraction.x);
  vec4 down = cubic_weights(taps.fraction.y);
  vec2 sum = vec2(0.0), low = vec2(1e30), high = vec2(-1e30);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      float weight = across[x] * down[y];
      if (weight == 0.0 || is_cubic_corner(x, y)) continue;
      ivec2 tap = clamp(taps.base + ivec2(x, y) - 1, ivec2(0), ivec2(frame.extent) - 1);
      vec2 value = imageLoad(previous_signal, tap).xy;
      sum += weight * value;
      if (x % 3 == 0 || y % 3 == 0) continue;
      low = min(low, value);
      high = max(high, value);
    }
  }
  return clamp(sum * cubic_scale(across, down), low, high);
}

HistorySample fetch_history(ivec2 pixel) {
  HistorySample history = HistorySample(vec2(0.0), vec4(0.0), vec2(0.0), vec2(0.0));
  if ((constants.flags & temporal_history_valid) == 0u) return history;
  vec4 map = imageLoad(reprojection, pixel);
  HistoryTaps taps = valid_taps(bilinear_taps(map.xy), uint(map.z));
  // The gradient compares with the long history alone.
  bool gradient = constants.rectification == rectification_gradient;
  bool bicubic = taps.whole && (constants.flags & temporal_bicubic) != 0u;
  for (int i = 0; i < 4; ++i) {
    float weight = taps.weights[i];
    if (weight <= 0.0) continue;
    ivec2 tap = taps.base + tap_offset(i);
    if (!bicubic) history.signal += weight * imageLoad(previous_signal, tap).xy;
    history.moments += weight * imageLoad(previous_moments, tap);
    history.frames += weight * imageLoad(previous_history, tap).xy;
    if (!gradient) history.fast += weight * imageLoad(previous_fast, tap).xy;
  }
  if (bicubic) history.signal = fetch_history_bicubic(taps);
  return history;
}

/// The history clamped to the current neighbourhood (paper section 3.1); each signal is a scalar of
/// its own, for which clipping is clamping.
vec2 rectify(ivec2 pixel, vec2 old) {
  bool by_window = constants.rectification >= rectification_color_clamp &&
                   constants.rectification <= rectification_variance_clip;
  if (!by_window) return old;
  Window window = empty_window();
  for (int y = -constants.radius; y <= constants.radius; ++y) {
    for (int x = -constants.radius; x <= constants.radius; ++x) {
      ivec2 tap = pixel + ivec2(x, y);
      if (!inside(tap, ivec2(frame.extent)) || guide_is_background(imageLoad(guide, tap))) continue;
      add(window, vec3(texelFetch(raw, tap, 0).xy, 0.0));
    }
  }
  Box box = rectification_box(window, constants.rectification, constants.scale);
  return clamp_to(box, vec3(old, 0.0)).xy;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec2 now = sanitize(texelFetch(raw, pixel, 0).rgb).xy;
  uvec4 rounding = rounding_of(pixel, frame.sample_index);
  if (guide_is_background(imageLoad(guide, pixel))) {
    imageStore(signal, pixel, vec4(now, vec2(0.0)));
    imageStore(kept, pixel, as_fractions(vec4(now, vec2(0.0)), rounding));
    imageStore(moments, pixel, vec4(0.0));
    imageStore(history, pixel, vec4(0.0));
    imageStore(fast, pixel, vec4(0.0));
    return;
  }
  HistorySample old = fetch_history(pixel);
  vec2 rectified = rectify(pixel, old.signal);
  vec2 moved = mix(vec2(0.0), abs(rectified - old.signal), greaterThan(old.frames, vec2(0.0)));

  if (constants.rectification == rectification_percentile) {
    vec4 tile = percentiles_at(pixel);
    moved = outdated_fraction(old.signal, tile.xz, tile.yw, constants.scale, vec2(0.25));
    old.frames *= 1.0 - moved;
  }

  // Moving lights shorten the history of shadows, not that of ambient visibility.
  vec2 longest = vec2(min(constants.frames, constants.light_frames), constants.frames);
  // The history counts what was sampled: without a sample it stays as it is.
  vec2 sampled = vec2(greaterThanEqual(now, vec2(0.0)));
  vec2 frames = min(old.frames + sampled, longest);
  vec2 value = mix(rectified, now, sampled / max(frames, vec2(1.0)));
  vec2 weight = sampled * sample_weight(frames, constants.moments_frames);
  vec2 first = mix(old.moments.xy, now, weight);
  vec2 second = mix(old.moments.zw, now * now, weight);
  vec2 variance = sample_variance(first, second, min(frames, vec2(constants.moments_frames)));
  if ((constants.flags & temporal_mean_variance) != 0u) variance /= max(frames, vec2(1.0));

  imageStore(signal, pixel, vec4(value, variance));
  imageStore(kept, pixel, as_fractions(vec4(value, variance), rounding));
  imageStore(moments, pixel, as_fractions(vec4(first, second), rounding));
  imageStore(history, pixel, as_halves(vec4(frames, moved), rounding));
  vec2 change = mix(vec2(0.0), now - old.signal, greaterThan(old.frames, vec2(0.0)));
  change = mix(vec2(change_unknown), change, sampled);
  vec2 recent = mix(old.fast, now, sampled * sample_weight(frames, fast_frames));
  bool gradient = constants.rectification == rectification_gradient;
  imageStore(fast, pixel, as_halves(vec4(gradient ? change : recent, 0.0, 0.0), rounding));
}
