// Reprojection: bilinear and cubic taps of the history, tests for disocclusion, and the virtual
// motion of reflections.
#ifndef HELIOGRAPH_REPROJECTION_GLSL
#define HELIOGRAPH_REPROJECTION_GLSL
#include "shared/denoise.h"

/// Four neighbouring pixels of the previous frame, weights adding up to 1, or all 0.
struct HistoryTaps {
  ivec2 base;
  vec4 weights;   // of base, base + (1,0), base + (0,1), base + (1,1)
  vec2 fraction;  // of the way from base to base + (1,1)
  bool whole;     // no pixel with a weight is invalid
};

ivec2 tap_offset(int tap) { return ivec2(tap & 1, tap >> 1); }

/// Bilinear weights about `position`, in pixels with centres at one half.
HistoryTaps bilinear_taps(vec2 position) {
  HistoryTaps taps;
  vec2 corner = position - 0.5;
  vec2 low = floor(corner);
  vec2 f = corner - low;
  taps.base = ivec2(low);
  taps.fraction = f;
  taps.whole = true;
  taps.weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  return taps;
}

/// Keeps the taps whose bit is set and renormalises their weights; all 0 where their sum is less
/// than min_tap_weight_sum.
HistoryTaps valid_taps(HistoryTaps taps, uint mask) {
  for (int i = 0; i < 4; ++i) {
    if ((mask & (1u << uint(i))) != 0u) continue;
    taps.whole = taps.whole && taps.weights[i] <= 0.0;
    taps.weights[i] = 0.0;
  }
  float sum = taps.weights.x + taps.weights.y + taps.weights.z + taps.weights.w;
  taps.weights = sum >= min_tap_weight_sum ? taps.weights / sum : vec4(0.0);
  return taps;
}

/// Catmull-Rom weights of four pixels in a row for a point at fraction `f` between the second and
/// the third. The history is resampled in every frame; bilinear weights would blur it a little each
/// time.
vec4 cubic_weights(float f) {
  return vec4(f * (-0.5 + f * (1.0 - 0.5 * f)), 1.0 + f * f * (1.5 * f - 2.5),
              f * (0.5 + f * (2.0 - 1.5 * f)), f * f * (0.5 * f - 0.5));
}

/// The corners of the 4x4 pixels weigh at most 1/64 together, of either sign: the cubic does without
/// them, and cubic_scale() makes the weights of the others add up to 1.
bool is_cubic_corner(int x, int y) { return x % 3 == 0 && y % 3 == 0; }
float cubic_scale(vec4 across, vec4 down) {
  return 1.0 / (1.0 - (across.x + across.w) * (down.x + down.w));
}

bool any_tap(HistoryTaps taps) { return any(greaterThan(taps.weights, vec4(0.0))); }

/// Whether `pixel` of the previous frame exists.
bool inside(ivec2 pixel, ivec2 size) {
  return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
}

/// Whether the view Z of the frame before is the expected one, within `tolerance` times the change
/// of Z from pixel to pixel. Scale invariant: every length is relative to the scene.
bool same_depth(float expected, float previous_z, vec2 slope, float footprint, float tolerance) {
  float change = abs(slope.x) + abs(slope.y) + 0.5 * footprint;
  return previous_z > 0.0 && abs(previous_z - expected) <= tolerance * change;
}

/// Whether the normal of the frame before is this one, within `tolerance` times the change of
/// normals from pixel to pixel (plus half a degree, for flat surfaces).
bool same_normal(vec3 normal, vec3 previous, float change, float tolerance) {
  return distance(normal, previous) <= tolerance * (change + 0.01) && dot(normal, previous) > 0.0;
}

/// Projects a world position, in widths and heights of the frame from its centre.
vec2 projected(mat4 view_projection, vec3 position) {
  vec4 clip = view_projection * vec4(position, 1.0);
  return clip.xy / clip.w * 0.5;
}

/// How far toward the hit the virtual position of a reflection lies: 1 in a mirror, 0 (at the
/// surface) where the lobe is wide (dominant direction of GGX, Lagarde and de Rousiers 2014).
float specular_dominant_factor(float roughness) {
  float smooth_part = 1.0 - roughness;
  return clamp(smooth_part * (sqrt(smooth_part) + roughness), 0.0, 1.0);
}

/// Distance behind a reflector of the curvature `curvature` (1 / radius, positive for convex) of
/// the virtual image of a point `distance` in front of it: the mirror equation, paraxial. Concave
/// reflectors show what is beyond their focus in front of them, which no position behind them
/// represents.
float virtual_distance(float distance, float curvature) {
  return distance / max(1.0 + 2.0 * curvature * distance, virtual_distance_min_divisor);
}

/// Separation of the two candidate positions, in pixels, from which the virtual motion is used and
/// not the surface motion: a long history may drift by half of the lobe, `pixels` wide, and no more
/// than noisy hit distances move the virtual position.
float virtual_motion_threshold(float pixels) {
  return min((1.0 + pixels) * virtual_threshold_per_pixel, virtual_threshold_max);
}

/// Maximum history length, in frames, of a moving reflection under a lobe `pixels` wide: a narrow
/// lobe has little noise, and shows every pixel of error in its virtual position.
float max_virtual_history(float pixels) {
  return virtual_history_per_pixel * max(pixels - virtual_history_min_lobe, 0.0);
}

/// Weight of the history at the surface's own position, where the virtual position lies
/// `separation` pixels beside it: a wide lobe averages over many pixels anyway.
float surface_history_weight(float roughness, float separation) {
  return exp(-separation / (surface_history_falloff_smooth +
                            surface_history_falloff_per_alpha * roughness * roughness));
}

/// Whether the frame before shows the same reflector, by the cosine between the normals and by the
/// roughnesses. `normal_change` is the change of normals from pixel to pixel, radians: neighbours
/// on a curved reflector may differ by as much.
bool same_reflector(float cosine, float roughness, float previous_roughness, float normal_change) {
  float least = min(mix(reflector_cosine_smooth, reflector_cosine_rough, roughness),
                    1.0 - 2.0 * normal_change * normal_change);
  return cosine > least &&
         abs(previous_roughness - roughness) <
             reflector_roughness_tolerance + reflector_roughness_tolerance_relative * roughness;
}

#endif
