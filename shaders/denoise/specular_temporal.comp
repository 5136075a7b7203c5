#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Gathers reflections over frames. What a mirror shows moves like the point behind it, what a rough
// surface shows like the surface: both places in the frame before are candidates.
#include "lib/frame.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/denoise/rectification.glsl"
#include "lib/denoise/reprojection.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D raw;  // radiance, hit distance
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 2, r32ui) readonly uniform uimage2D instance;
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D reprojection;
layout(set = 1, binding = 4, rgba32f) readonly uniform image2D previous_normals;
layout(set = 1, binding = 5, rgba8) readonly uniform image2D previous_surface;
layout(set = 1, binding = 6, rgba32f) readonly uniform image2D previous_motion;
layout(set = 1, binding = 7, r32ui) readonly uniform uimage2D previous_instance;
layout(set = 1, binding = 8, rgba32f) readonly uniform image2D previous_signal;
layout(set = 1, binding = 9, rgba32f) readonly uniform image2D previous_history;
layout(set = 1, binding = 10, rgba32f) readonly uniform image2D previous_fast;
layout(set = 1, binding = 11, rgba32f) readonly uniform image2D percentiles;  // of tiles, or anything
layout(set = 1, binding = 12, rgba32f) writeonly uniform image2D signal;   // radiance, variance
layout(set = 1, binding = 13, rgba32f) writeonly uniform image2D history;  // frames, moved, moments
layout(set = 1, binding = 14, rgba32f) writeonly uniform image2D fast;     // the last few frames,
                                                                          // or the change
layout(push_constant) uniform Constants { TemporalConstants constants; };

#include "lib/denoise/percentile_tiles.glsl"

const float fast_frames = 6.0;

struct Remembered {
  vec3 radiance;
  float frames;  // 0: nothing
  vec2 moments;
  vec3 fast;
};

struct Surface {
  ivec2 pixel;
  vec3 normal;
  float roughness;
  float view_z;
};

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

vec4 sample_at(ivec2 pixel) {
  vec4 found = imageLoad(raw, pixel);
  return vec4(scrub(found.rgb), scrub(found.w));
}

Remembered nothing() { return Remembered(vec3(0.0), 0.0, vec2(0.0), vec3(0.0)); }

/// The remembered signal between pixels, without the blur of bilinear weights. Held to the four
/// nearest pixels: a cubic overshoots at edges, and farther pixels may show other surfaces.
vec3 recall_sharply(HistoryTaps taps) {
  vec4 across = cubic_weights(taps.fraction.x);
  vec4 down = cubic_weights(taps.fraction.y);
  vec3 sum = vec3(0.0), low = vec3(1e30), high = vec3(-1e30);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      float weight = across[x] * down[y];
      if (weight == 0.0) continue;
      ivec2 tap = clamp(taps.base + ivec2(x, y) - 1, ivec2(0), ivec2(frame.extent) - 1);
      vec3 value = imageLoad(previous_signal, tap).rgb;
      sum += weight * value;
      if (x % 3 == 0 || y % 3 == 0) continue;
      low = min(low, value);
      high = max(high, value);
    }
  }
  return clamp(sum, low, high);
}

Remembered recall(HistoryTaps taps) {
  Remembered found = nothing();
  for (int i = 0; i < 4; ++i) {
    float weight = taps.weights[i];
    if (weight <= 0.0) continue;
    ivec2 tap = taps.base + tap_offset(i);
    vec4 state = imageLoad(previous_history, tap);
    found.radiance += weight * imageLoad(previous_signal, tap).rgb;
    found.frames += weight * state.x;
    found.moments += weight * state.zw;
    found.fast += weight * imageLoad(previous_fast, tap).rgb;
  }
  if (taps.whole && (constants.flags & temporal_bicubic) != 0u) {
    found.radiance = recall_sharply(taps);
  }
  return found;
}

/// The shortest of the neighbours' hit distances on the same kind of surface: one sample's own is
/// as noisy as its radiance, and a reflection sharpens toward what touches it.
float hit_distance(ivec2 pixel) {
  float nearest = 1e9;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 tap = pixel + ivec2(x, y);
      if (!inside(tap, ivec2(frame.extent))) continue;
      float found = sample_at(tap).w;
      if (found > 0.0) nearest = min(nearest, found);
    }
  }
  return nearest < 1e9 ? nearest : 0.0;
}

/// How a mirror bends: how fast its normal turns along the surface (1 / metres, positive where it
/// bulges), and how far from pixel to pixel. Means over the neighbours to the left, right, above and
/// below on the same thing.
struct Bend {
  float curvature;
  float turn;
};

Bend bend(Surface s, vec3 position) {
  if ((constants.flags & temporal_curved_reflectors) == 0u) return Bend(0.0, 0.0);
  uint own = imageLoad(instance, s.pixel).r;
  vec2 sum = vec2(0.0);
  float count = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 beside = s.pixel + (i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5));
    if (!inside(beside, ivec2(frame.extent)) || imageLoad(instance, beside).r != own) continue;
    Guide found = decode_guide(imageLoad(guide, beside));
    vec3 step = world_position(beside, found.view_z) - position;
    vec3 turn = found.normal - s.normal;
    sum += vec2(dot(turn, step) / max(dot(step, step), 1e-20), length(turn));
    count += 1.0;
  }
  return count > 0.0 ? Bend(sum.x / count, sum.y / count) : Bend(0.0, 0.0);
}

/// From where a point behind a pixel is seen to where it was seen in the frame before, in pixels.
vec2 motion_of(vec3 point) {
  // Both without jitter, and through the same arithmetic: a resting view gives exactly zero.
  return (projected(frame.previous_unjittered, point) - projected(frame.unjittered, point)) *
         vec2(frame.extent);
}

/// From this frame's pixel to where the virtual point was in the frame before, in pixels. A bent
/// mirror seen from the side has two: its focus lies nearer within the plane of incidence than
/// across it (Coddington's equations), and each moves its share of the picture.
vec2 virtual_motion(Surface s, vec3 position, Bend bend) {
  vec3 eye = to_eye(s.pixel);
  float far = hit_distance(s.pixel), share = lobe_share(s.roughness);
  float cosine = clamp(dot(s.normal, eye), 0.2, 1.0);
  vec2 within =
      motion_of(position - eye * (share * mirrored_distance(far, bend.curvature / cosine)));
  if (bend.curvature == 0.0) return within;
  vec2 across =
      motion_of(position - eye * (share * mirrored_distance(far, bend.curvature * cosine)));
  vec2 plane = (mat3(frame.view) * s.normal).xy * sign(frame.unproject.xy);
  plane /= max(length(plane), 1e-6);
  return across + plane * dot(within - across, plane);
}

/// Whether the frame before shows the same mirror there: the surface is compared, not the depth of
/// what is behind it. Where the normal turns from pixel to pixel, so may that of a neighbour.
bool same_mirror(ivec2 pixel, Surface s, float turn) {
  if (!inside(pixel, ivec2(frame.extent))) return false;
  if (imageLoad(previous_instance, pixel).r != imageLoad(instance, s.pixel).r) return false;
  float found_z = imageLoad(previous_motion, pixel).w;
  if (found_z <= 0.0) return false;
  vec3 normal = octahedral_decode(imageLoad(previous_normals, pixel).xy);
  float allowed = min(mix(0.9995, 0.95, s.roughness), 1.0 - 2.0 * turn * turn);
  float roughness = imageLoad(previous_surface, pixel).r;
  return dot(normal, s.normal) > allowed && abs(roughness - s.roughness) < 0.05 + 0.25 * s.roughness;
}

HistoryTaps virtual_taps(Surface s, vec2 motion, float turn) {
  vec2 position = vec2(s.pixel) + 0.5 + motion;
  HistoryTaps taps = bilinear_taps(position);
  uint mask = 0u;
  for (int i = 0; i < 4; ++i) {
    if (taps.weights[i] <= 0.0) continue;
    if (same_mirror(taps.base + tap_offset(i), s, turn)) mask |= 1u << uint(i);
  }
  return valid_taps(taps, mask);
}

Window window_about(ivec2 pixel) {
  Window window = empty_window();
  for (int y = -constants.radius; y <= constants.radius; ++y) {
    for (int x = -constants.radius; x <= constants.radius; ++x) {
      ivec2 tap = pixel + ivec2(x, y);
      if (!inside(tap, ivec2(frame.extent)) || guide_is_background(imageLoad(guide, tap))) continue;
      add(window, to_ycocg(sample_at(tap).rgb));
    }
  }
  return window;
}

/// The old radiance as far as the current neighbourhood allows (paper section 3.1), in YCoCg.
vec3 rectify(ivec2 pixel, vec3 old) {
  uint mode = constants.rectification;
  if (mode < rectification_color_clamp || mode > rectification_variance_clip) return old;
  Box box = rectification_box(window_about(pixel), mode, constants.scale);
  vec3 color = to_ycocg(old);
  return from_ycocg(clips(mode) ? clip_to(box, color) : clamp_to(box, color));
}

/// Both candidates as one memory.
Remembered remembered(Surface s) {
  if ((constants.flags & temporal_holds) == 0u) return nothing();
  vec4 map = imageLoad(reprojection, s.pixel);
  HistoryTaps own = valid_taps(bilinear_taps(map.xy), uint(map.z));
  if ((constants.flags & temporal_virtual_motion) == 0u) return recall(own);
  vec3 position = world_position(s.pixel, s.view_z);
  Bend bend = bend(s, position);
  vec2 motion = virtual_motion(s, position, bend);
  HistoryTaps mirrored = virtual_taps(s, motion, bend.turn);
  vec2 own_motion = map.xy - (vec2(s.pixel) + 0.5);
  float apart = distance(own_motion, motion);
  float lobe = lobe_pixels(s.roughness);
  if (any_tap(mirrored) && (apart > worth_parting(lobe) || !any_tap(own))) {
    Remembered found = recall(mirrored);
    found.frames = min(found.frames, mirror_memory(lobe));
    return found;
  }
  // The surface's own history shows another part of the reflection, the sharper the mirror and the
  // further the two places are apart.
  Remembered found = recall(own);
  found.frames *= surface_trust(s.roughness, apart);
  return found;
}

/// In frames. Of a reflection only a part comes straight from lights: where they move it may be
/// remembered four times as long as shadows (measured). A turning environment moves all of it, the
/// faster the narrower the lobe that gathers it.
float longest_memory(float roughness) {
  float longest = min(constants.frames, 4.0 * constants.light_frames);
  if (constants.environment_turn <= 0.0) return longest;
  float lobe = 4.0 * atan(roughness * roughness);  // from edge to edge, radians
  float motion = constants.environment_turn / max(lobe, 1e-4);
  return min(longest, frames_under_motion(motion));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec4 guided = imageLoad(guide, pixel);
  vec3 now = sample_at(pixel).rgb;
  if (guide_is_background(guided)) {
    imageStore(signal, pixel, vec4(0.0));
    imageStore(history, pixel, vec4(0.0));
    imageStore(fast, pixel, vec4(0.0));
    return;
  }
  Guide g = decode_guide(guided);
  Surface s = Surface(pixel, g.normal, g.roughness, g.view_z);
  Remembered old = remembered(s);
  vec3 rectified = rectify(pixel, old.radiance);
  float moved = old.frames > 0.0 ? abs(luminance(rectified) - luminance(old.radiance)) : 0.0;

  if (constants.rectification == rectification_percentile) {
    vec2 tile = percentiles_at(pixel).xy;
    now *= firefly_scale(luminance(now), tile.x, tile.y);
    moved = outdated_share(vec2(luminance(old.radiance)), tile.xx, tile.yy, constants.scale,
                           vec2(0.1 * tile.y + 1e-4)).x;
    old.frames *= 1.0 - moved;
  }

  float frames = min(old.frames + 1.0, longest_memory(s.roughness));
  vec3 radiance = mix(rectified, now, 1.0 / frames);
  float share = 1.0 / min(frames, constants.moments_frames);
  float bright = luminance(now);
  vec2 moments = mix(old.moments, vec2(bright, bright * bright), share);
  float variance = sample_variance(moments.xx, moments.yy,
                                   vec2(min(frames, constants.moments_frames))).x;
  if ((constants.flags & temporal_mean_variance) != 0u) variance /= frames;

  imageStore(signal, pixel, vec4(radiance, variance));
  imageStore(history, pixel, vec4(frames, moved, moments));
  vec3 change = old.frames > 0.0 ? now - old.radiance : vec3(0.0);
  vec3 recent = mix(old.fast, now, 1.0 / min(frames, fast_frames));
  bool gradient = constants.rectification == rectification_gradient;
  imageStore(fast, pixel, vec4(gradient ? change : recent, 0.0));
}
