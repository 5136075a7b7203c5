// Rectification: the history is clamped or clipped to the current neighbourhood (paper section
// 3.1).
#ifndef HELIOGRAPH_RECTIFICATION_GLSL
#define HELIOGRAPH_RECTIFICATION_GLSL
#include "shared/denoise.h"

struct Box {
  vec3 low;
  vec3 high;
};

/// Statistics of a window of the current frame.
struct Window {
  Box range;
  vec3 sum;
  vec3 squares;
  float count;
};

Window empty_window() {
  return Window(Box(vec3(1e30), vec3(-1e30)), vec3(0.0), vec3(0.0), 0.0);
}

void add(inout Window window, vec3 color) {
  window.range.low = min(window.range.low, color);
  window.range.high = max(window.range.high, color);
  window.sum += color;
  window.squares += color * color;
  window.count += 1.0;
}

/// Mean +- scale x standard deviation (Salvi 2016).
Box variance_box(Window window, float scale) {
  vec3 mean = window.sum / max(window.count, 1.0);
  vec3 variance = max(window.squares / max(window.count, 1.0) - mean * mean, vec3(0.0));
  vec3 half_extent = scale * sqrt(variance);
  return Box(mean - half_extent, mean + half_extent);
}

Box rectification_box(Window window, uint mode, float scale) {
  bool by_range = mode == rectification_color_clamp || mode == rectification_color_clip;
  if (by_range) return window.range;
  return variance_box(window, scale);
}

vec3 clamp_to(Box box, vec3 color) { return clamp(color, box.low, box.high); }

/// The point where the line from the box's centre to `color` leaves the box, or `color` inside it.
vec3 clip_to(Box box, vec3 color) {
  vec3 middle = 0.5 * (box.low + box.high);
  vec3 half_extent = max(0.5 * (box.high - box.low), vec3(1e-7));
  vec3 offset = color - middle;
  vec3 overshoot = abs(offset / half_extent);
  float largest = max(overshoot.x, max(overshoot.y, overshoot.z));
  return largest > 1.0 ? middle + offset / largest : color;
}

bool clips(uint mode) {
  return mode == rectification_color_clip || mode == rectification_variance_clip;
}

/// Fraction of a history to drop whose brightness lies outside the percentiles `low` and `high` of
/// the current neighbourhood, 0..max_outdated_fraction: all of that where it is further out than
/// `scale` times their spread and `smallest` (Alber 2025).
vec2 outdated_fraction(vec2 old, vec2 low, vec2 high, float scale, vec2 smallest) {
  vec2 outside = max(max(old - high, low - old), vec2(0.0));
  return max_outdated_fraction *
         clamp(outside / (scale * (high - low) + smallest), vec2(0.0), vec2(1.0));
}

/// Factor that scales a sample far brighter than its neighbours (a firefly) down to their range.
float firefly_scale(float bright, float low, float high) {
  float most = high + 8.0 * (high - low) + 0.1 * high + 1e-3;
  return bright > most ? most / bright : 1.0;
}

/// History length after a value was `moved` by a box of half width `half_extent`: unchanged where
/// it was not moved, the shorter the further it was moved relative to the box.
vec2 shortened_history(vec2 frames, vec2 moved, vec2 half_extent) {
  vec2 moved_fraction = moved / max(moved + half_extent, vec2(1e-6));
  return max(frames * (1.0 - moved_fraction), min(frames, vec2(1.0)));
}

/// Within which bounds the mean change of a window that shows so many `surfaces` lies. It is the
/// less certain the fewer of them were sampled: `scale` is that of all. Where it is less than the
/// fraction `least`, rounded, nothing is known.
Box mean_box(Window window, float surfaces, float scale, float least) {
  if (window.count < least * surfaces - 0.5) return Box(vec3(-1e30), vec3(1e30));
  return variance_box(window, scale * sqrt(surfaces / max(window.count, 1.0)));
}

Box widened(Box box, float by) { return Box(box.low - by, box.high + by); }

/// Significant change of a neighbourhood: the distance of the box of its mean change from 0.
vec3 certain_change(Box box) { return max(max(box.low, -box.high), vec3(0.0)); }

vec3 to_ycocg(vec3 c) {
  return vec3(0.25 * c.r + 0.5 * c.g + 0.25 * c.b, 0.5 * (c.r - c.b),
              -0.25 * c.r + 0.5 * c.g - 0.25 * c.b);
}

vec3 from_ycocg(vec3 c) {
  float rest = c.x - c.z;
  return vec3(rest + c.y, c.x + c.z, rest - c.y);
}

#endif
