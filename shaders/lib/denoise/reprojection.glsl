// Where a surface was one frame ago, and whether what is remembered there is still it.
#ifndef HELIOGRAPH_REPROJECTION_GLSL
#define HELIOGRAPH_REPROJECTION_GLSL

/// Four neighbouring pixels of the previous frame, weights adding up to 1, or all 0.
struct HistoryTaps {
  ivec2 base;
  vec4 weights;   // of base, base + (1,0), base + (0,1), base + (1,1)
  vec2 fraction;  // of the way from base to base + (1,1)
  bool whole;     // no pixel that counts is missing
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

/// Keeps the taps whose bit is set and makes their weights add up to 1; all 0 where what is left
/// is less than one hundredth.
HistoryTaps valid_taps(HistoryTaps taps, uint mask) {
  for (int i = 0; i < 4; ++i) {
    if ((mask & (1u << uint(i))) != 0u) continue;
    taps.whole = taps.whole && taps.weights[i] <= 0.0;
    taps.weights[i] = 0.0;
  }
  float sum = taps.weights.x + taps.weights.y + taps.weights.z + taps.weights.w;
  taps.weights = sum >= 0.01 ? taps.weights / sum : vec4(0.0);
  return taps;
}

/// Weights of four pixels in a row for a point `f` of the way from the second to the third: the
/// cubic of Catmull and Rom. What is remembered is read anew in every frame; read with the bilinear
/// weights it would be blurred a little each time.
vec4 cubic_weights(float f) {
  return vec4(f * (-0.5 + f * (1.0 - 0.5 * f)), 1.0 + f * f * (1.5 * f - 2.5),
              f * (0.5 + f * (2.0 - 1.5 * f)), f * f * (0.5 * f - 0.5));
}

bool any_tap(HistoryTaps taps) { return any(greaterThan(taps.weights, vec4(0.0))); }

/// Whether `pixel` of the previous frame exists.
bool inside(ivec2 pixel, ivec2 size) {
  return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
}

/// Whether a remembered view Z is the expected one, within `tolerance` times what Z changes from
/// pixel to pixel. Free of scale: every length is the scene's own.
bool same_depth(float expected, float found, vec2 slope, float footprint, float tolerance) {
  float change = abs(slope.x) + abs(slope.y) + 0.5 * footprint;
  return found > 0.0 && abs(found - expected) <= tolerance * change;
}

/// Whether a remembered normal is this one, within `tolerance` times what normals change here from
/// pixel to pixel (or half a degree, where they do not).
bool same_normal(vec3 normal, vec3 found, float change, float tolerance) {
  return distance(normal, found) <= tolerance * (change + 0.01) && dot(normal, found) > 0.0;
}

/// Where a world position is seen, in widths and heights of the picture from its middle.
vec2 projected(mat4 view_projection, vec3 position) {
  vec4 clip = view_projection * vec4(position, 1.0);
  return clip.xy / clip.w * 0.5;
}

/// How far toward the hit the reflection's virtual point lies: all the way in a mirror, at the
/// surface where the lobe is wide (dominant direction of GGX, Lagarde and de Rousiers 2014).
float lobe_share(float roughness) {
  float smooth_part = 1.0 - roughness;
  return clamp(smooth_part * (sqrt(smooth_part) + roughness), 0.0, 1.0);
}

/// How far behind a mirror with the curvature `curvature` (1 / radius, positive where it bulges)
/// what is `distance` before it appears: the mirror equation, near the axis. Hollow mirrors show
/// what is beyond their focus before them, which no single place behind them stands for.
float mirrored_distance(float distance, float curvature) {
  return distance / max(1.0 + 2.0 * curvature * distance, 0.25);
}

/// From how many pixels between the two places on the virtual point is followed, not the surface:
/// what a long memory drifts by may be half of the lobe, `pixels` wide, and no more than noisy hit
/// distances move the virtual point by.
float worth_parting(float pixels) { return min((1.0 + pixels) / 64.0, 0.5); }

/// How many frames of a moving reflection are worth remembering under a lobe `pixels` wide: a narrow
/// one brings little noise, and shows every pixel that its virtual point is off.
float mirror_memory(float pixels) { return 8.0 * max(pixels - 0.25, 0.0); }

/// Share of a surface's own history that still shows its reflection, where the reflection's
/// virtual point lies `apart` pixels beside it: a wide lobe averages over many pixels anyway.
float surface_trust(float roughness, float apart) {
  return exp(-apart / (0.25 + 64.0 * roughness * roughness));
}

#endif
