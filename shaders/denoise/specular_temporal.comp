#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Temporal accumulation of reflections. A smooth reflector's image moves with the virtual position
// behind it (virtual motion), a rough one's with the surface (surface motion): the history at
// either position is a candidate.
#include "lib/frame.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/denoise/history_texels.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/math/luminance.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/denoise/rectification.glsl"
#include "lib/denoise/reprojection.glsl"

// Textures, whose unit turns 16 bits into floats.
layout(set = 1, binding = 0) uniform sampler2D raw;  // radiance, hit distance
layout(set = 1, binding = 1) uniform sampler2D guide;
layout(set = 1, binding = 2) uniform usampler2D instance;
layout(set = 1, binding = 3) uniform sampler2D reprojection;
layout(set = 1, binding = 4) uniform sampler2D previous_normals;
layout(set = 1, binding = 5) uniform sampler2D previous_surface;
layout(set = 1, binding = 6) uniform usampler2D previous_instance;
layout(set = 1, binding = 7) uniform sampler2D previous_signal;
layout(set = 1, binding = 8) uniform sampler2D previous_history;
layout(set = 1, binding = 9) uniform sampler2D previous_fast;
layout(set = 1, binding = 10) uniform sampler2D percentiles;  // of tiles, or anything
layout(set = 1, binding = 11, rgba32f) writeonly uniform image2D signal;   // radiance, variance
layout(set = 1, binding = 12, rgba16f) writeonly uniform image2D kept;     // radiance, distance
// Frames, how far rectification moved the mean, mean and deviation of the brightness of samples.
layout(set = 1, binding = 13, rgba16f) writeonly uniform image2D history;
// The last few frames or the change; the raw distance.
layout(set = 1, binding = 14, rgba16f) writeonly uniform image2D fast;
layout(push_constant) uniform Constants { TemporalConstants constants; };

#include "lib/denoise/percentile_tiles.glsl"

const float fast_frames = 6.0;

struct HistorySample {
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

vec4 sample_at(ivec2 pixel) {
  vec4 texel = texelFetch(raw, pixel, 0);
  return vec4(sanitize(texel.rgb), sanitize(texel.w));
}

// Of the group's pixels and those around them: the texels of images that many pixels want take
// longest to read.
const int group_side = 8;
const int side = group_side + 2;
shared float distances[side * side];  // of hits; 0 outside the frame
shared uint instances[side * side];   // 0 outside the frame
shared vec4 guides[side * side];

int place_of(ivec2 offset) {
  ivec2 place = ivec2(gl_LocalInvocationID.xy) + 1 + offset;
  return place.y * side + place.x;
}

/// Whether this frame looks for where reflections were.
bool follows_reflections() {
  const uint needed = temporal_history_valid | temporal_virtual_motion;
  return (constants.flags & needed) == needed;
}

/// By all invocations.
void read_surroundings() {
  ivec2 corner = ivec2(gl_WorkGroupID.xy) * group_side - 1;
  for (int i = int(gl_LocalInvocationIndex); i < side * side; i += group_side * group_side) {
    ivec2 tap = corner + ivec2(i % side, i / side);
    bool shown = inside(tap, ivec2(frame.extent));
    distances[i] = shown ? abs(sanitize(texelFetch(raw, tap, 0).w)) : 0.0;
    instances[i] = shown ? texelFetch(instance, tap, 0).r : 0u;
    guides[i] = shown ? texelFetch(guide, tap, 0) : vec4(0.0);
  }
  barrier();
}

HistorySample no_history() { return HistorySample(vec3(0.0), 0.0, vec2(0.0), vec3(0.0)); }

/// The history between pixels, without the blur of bilinear weights. Clamped to the four nearest
/// pixels: a cubic overshoots at edges, and farther pixels may show other surfaces.
vec3 fetch_history_bicubic(HistoryTaps taps) {
  vec4 across = cubic_weights(taps.fraction.x);
  vec4 down = cubic_weights(taps.fraction.y);
  vec3 sum = vec3(0.0), low = vec3(1e30), high = vec3(-1e30);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      float weight = across[x] * down[y];
      if (weight == 0.0 || is_cubic_corner(x, y)) continue;
      ivec2 tap = clamp(taps.base + ivec2(x, y) - 1, ivec2(0), ivec2(frame.extent) - 1);
      vec3 value = texelFetch(previous_signal, tap, 0).rgb;
      sum += weight * value;
      if (x % 3 == 0 || y % 3 == 0) continue;
      low = min(low, value);
      high = max(high, value);
    }
  }
  return clamp(sum * cubic_scale(across, down), low, high);
}

HistorySample fetch_history(HistoryTaps taps) {
  HistorySample history = no_history();
  // The gradient compares with the long history alone.
  bool gradient = constants.rectification == rectification_gradient;
  bool bicubic = taps.whole && (constants.flags & temporal_bicubic) != 0u;
  for (int i = 0; i < 4; ++i) {
    float weight = taps.weights[i];
    if (weight <= 0.0) continue;
    ivec2 tap = taps.base + tap_offset(i);
    vec4 state = texelFetch(previous_history, tap, 0);
    if (!bicubic) history.radiance += weight * texelFetch(previous_signal, tap, 0).rgb;
    history.frames += weight * state.x;
    history.moments += weight * vec2(state.z, dot(state.zw, state.zw));
    if (!gradient) history.fast += weight * texelFetch(previous_fast, tap, 0).rgb;
  }
  if (bicubic) history.radiance = fetch_history_bicubic(taps);
  return history;
}

/// The shortest of the neighbours' hit distances on the same kind of surface: one sample's own is
/// as noisy as its radiance, and a reflection sharpens toward what touches it. Where no sample was
/// taken the distance of the frame before stands, negated.
float hit_distance() {
  float nearest = 1e9;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float hit = distances[place_of(ivec2(x, y))];
      if (hit > 0.0) nearest = min(nearest, hit);
    }
  }
  return nearest < 1e9 ? nearest : 0.0;
}

/// Curvature of a reflector: change of its normal along the surface (1 / metres, positive for
/// convex), and from pixel to pixel (radians). Means over the four neighbours of the same instance.
struct Curvature {
  float curvature;
  float normal_change;
};

Curvature local_curvature(Surface s, vec3 position) {
  if ((constants.flags & temporal_curved_reflectors) == 0u) return Curvature(0.0, 0.0);
  uint own = instances[place_of(ivec2(0))];
  vec2 sum = vec2(0.0);
  float count = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5);
    int beside = place_of(offset);
    if (instances[beside] != own) continue;
    Guide neighbour = decode_guide(guides[beside]);
    vec3 step = world_position(s.pixel + offset, neighbour.view_z) - position;
    vec3 normal_change = neighbour.normal - s.normal;
    sum += vec2(dot(normal_change, step) / max(dot(step, step), 1e-20), length(normal_change));
    count += 1.0;
  }
  return count > 0.0 ? Curvature(sum.x / count, sum.y / count) : Curvature(0.0, 0.0);
}

/// Screen motion of a world position from this frame to the frame before, in pixels.
vec2 motion_of(vec3 point) {
  // Both without jitter, and through the same arithmetic: a static view gives exactly zero.
  return (projected(frame.previous_unjittered, point) - projected(frame.unjittered, point)) *
         vec2(frame.extent);
}

/// Motion of the reflection's virtual position from this frame to the frame before, in pixels. A
/// curved reflector at oblique incidence has two: its focus within the plane of incidence is nearer
/// than across it (Coddington's equations), and each determines the motion along its own axis.
vec2 virtual_motion(Surface s, vec3 position, float curvature) {
  vec3 eye = to_eye(s.pixel);
  float far = hit_distance(), dominant_factor = specular_dominant_factor(s.roughness);
  float cosine = clamp(dot(s.normal, eye), reflector_min_cosine, 1.0);
  vec2 within =
      motion_of(position - eye * (dominant_factor * virtual_distance(far, curvature / cosine)));
  if (curvature == 0.0) return within;
  vec2 across =
      motion_of(position - eye * (dominant_factor * virtual_distance(far, curvature * cosine)));
  vec2 plane = (mat3(frame.view) * s.normal).xy * sign(frame.unproject.xy);
  plane /= max(length(plane), 1e-6);
  return across + plane * dot(within - across, plane);
}

/// Whether `pixel` of the frame before shows the same reflector: the surface is compared, not the
/// depth of what it reflects. Pixels that show none have no instance.
bool shows_reflector(ivec2 pixel, Surface s, float normal_change) {
  if (!inside(pixel, ivec2(frame.extent))) return false;
  if (texelFetch(previous_instance, pixel, 0).r != instances[place_of(ivec2(0))]) return false;
  vec3 normal = octahedral_decode(texelFetch(previous_normals, pixel, 0).xy);
  float roughness = texelFetch(previous_surface, pixel, 0).r;
  return same_reflector(dot(normal, s.normal), s.roughness, roughness, normal_change);
}

HistoryTaps virtual_taps(Surface s, vec2 motion, float normal_change) {
  vec2 position = vec2(s.pixel) + 0.5 + motion;
  HistoryTaps taps = bilinear_taps(position);
  uint mask = 0u;
  for (int i = 0; i < 4; ++i) {
    if (taps.weights[i] <= 0.0) continue;
    if (shows_reflector(taps.base + tap_offset(i), s, normal_change)) mask |= 1u << uint(i);
  }
  return valid_taps(taps, mask);
}

Window window_about(ivec2 pixel) {
  Window window = empty_window();
  for (int y = -constants.radius; y <= constants.radius; ++y) {
    for (int x = -constants.radius; x <= constants.radius; ++x) {
      ivec2 tap = pixel + ivec2(x, y);
      if (!inside(tap, ivec2(frame.extent))) continue;
      if (guide_is_background(texelFetch(guide, tap, 0))) continue;
      add(window, to_ycocg(sample_at(tap).rgb));
    }
  }
  return window;
}

/// The history's radiance clamped or clipped to the current neighbourhood (paper section 3.1), in
/// YCoCg.
vec3 rectify(ivec2 pixel, vec3 old) {
  uint mode = constants.rectification;
  if (mode < rectification_color_clamp || mode > rectification_variance_clip) return old;
  Box box = rectification_box(window_about(pixel), mode, constants.scale);
  vec3 color = to_ycocg(old);
  return from_ycocg(clips(mode) ? clip_to(box, color) : clamp_to(box, color));
}

/// The history of the better candidate.
HistorySample reprojected_history(Surface s) {
  if ((constants.flags & temporal_history_valid) == 0u) return no_history();
  vec4 map = texelFetch(reprojection, s.pixel, 0);
  HistoryTaps own = valid_taps(bilinear_taps(map.xy), uint(map.z));
  if (!follows_reflections()) return fetch_history(own);
  vec3 position = world_position(s.pixel, s.view_z);
  Curvature curvature = local_curvature(s, position);
  vec2 motion = virtual_motion(s, position, curvature.curvature);
  HistoryTaps reflected = virtual_taps(s, motion, curvature.normal_change);
  vec2 own_motion = map.xy - (vec2(s.pixel) + 0.5);
  float separation = distance(own_motion, motion);
  float lobe = lobe_pixels(s.roughness);
  if (any_tap(reflected) && (separation > virtual_motion_threshold(lobe) || !any_tap(own))) {
    HistorySample history = fetch_history(reflected);
    history.frames = min(history.frames, max_virtual_history(lobe));
    return history;
  }
  // The history at the surface's position shows another part of the reflection, the more so the
  // smoother the reflector and the larger the separation.
  HistorySample history = fetch_history(own);
  history.frames *= surface_history_weight(s.roughness, separation);
  return history;
}

/// Maximum history length, in frames. Only part of a reflection is lit directly by lights: where
/// they move its history may be longer than that of shadows. A rotating environment moves all of
/// it, the faster the narrower the lobe.
float max_history_frames(float roughness) {
  float longest = min(constants.frames, specular_light_history_scale * constants.light_frames);
  if (constants.environment_turn <= 0.0) return longest;
  float lobe = 4.0 * atan(roughness * roughness);  // from edge to edge, radians
  float motion = constants.environment_turn / max(lobe, 1e-4);
  return min(longest, frames_under_motion(motion));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (follows_reflections()) read_surroundings();
  if (outside_frame(pixel)) return;
  vec4 guided = texelFetch(guide, pixel, 0);
  vec4 raw_sample = sample_at(pixel);
  vec3 now = raw_sample.rgb;
  // The history counts what was sampled: without a sample it stays as it is.
  float sampled = raw_sample.w < 0.0 ? 0.0 : 1.0;
  uvec4 rounding = rounding_of(pixel, frame.sample_index);
  if (guide_is_background(guided)) {
    imageStore(signal, pixel, vec4(0.0));
    imageStore(kept, pixel, vec4(0.0));
    imageStore(history, pixel, vec4(0.0));
    imageStore(fast, pixel, vec4(0.0));
    return;
  }
  Guide g = decode_guide(guided);
  Surface s = Surface(pixel, g.normal, g.roughness, g.view_z);
  HistorySample old = reprojected_history(s);
  vec3 rectified = rectify(pixel, old.radiance);
  float moved = old.frames > 0.0 ? abs(luminance(rectified) - luminance(old.radiance)) : 0.0;

  if (constants.rectification == rectification_percentile) {
    vec2 tile = percentiles_at(pixel).xy;
    now *= firefly_scale(luminance(now), tile.x, tile.y);
    moved = outdated_fraction(vec2(luminance(old.radiance)), tile.xx, tile.yy, constants.scale,
                           vec2(0.1 * tile.y + 1e-4)).x;
    old.frames *= 1.0 - moved;
  }

  float frames = min(old.frames + sampled, max_history_frames(s.roughness));
  vec3 radiance = mix(rectified, now, sampled / max(frames, 1.0));
  float weight = sampled / clamp(frames, 1.0, constants.moments_frames);
  float bright = luminance(now);
  vec2 moments = mix(old.moments, vec2(bright, bright * bright), weight);
  float variance = sample_variance(moments.xx, moments.yy,
                                   vec2(min(frames, constants.moments_frames))).x;
  if ((constants.flags & temporal_mean_variance) != 0u) variance /= max(frames, 1.0);

  imageStore(signal, pixel, vec4(radiance, variance));
  float deviation = sqrt(max(moments.y - moments.x * moments.x, 0.0));
  imageStore(kept, pixel, as_halves(vec4(radiance, raw_sample.w), rounding));
  imageStore(history, pixel, as_halves(vec4(frames, moved, moments.x, deviation), rounding));
  vec3 change = old.frames > 0.0 ? sampled * (now - old.radiance) : vec3(0.0);
  vec3 recent = mix(old.fast, now, sampled / clamp(frames, 1.0, fast_frames));
  bool gradient = constants.rectification == rectification_gradient;
  imageStore(fast, pixel, as_halves(vec4(gradient ? change : recent, raw_sample.w), rounding));
}
