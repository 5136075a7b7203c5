// What a pixel shows through the lens, gathered from the pixels around it. The shader says what
// light there is, of one frame or of two that are blurred alike: mat2x4 light_at(ivec2 pixel).
#ifndef HELIOGRAPH_DEFOCUS_GATHER_GLSL
#define HELIOGRAPH_DEFOCUS_GATHER_GLSL
#include "lib/lens/defocus.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D motion;  // w: view Z
layout(set = 1, binding = 1, std430) readonly buffer Reach { float reach[]; };

const float smallest_blur = 0.5;  // pixels: what is less blurred is sharp

/// Interleaved gradient noise (Jimenez 2014), other in every frame.
float gradient_noise(ivec2 pixel) {
  vec2 at = vec2(pixel) + 5.588238 * float(frame.sample_index % 64u);
  return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715))));
}

/// How far circles in front of the focus may reach into this pixel.
float reach_of_front(ivec2 pixel) {
  ivec2 tiles = ivec2(defocus_tiles(frame.extent));
  ivec2 tile = pixel / int(defocus_tile(frame.extent));
  ivec2 first = max(tile - 2, ivec2(0)), last = min(tile + 2, tiles - 1);
  float largest = 0.0;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) largest = max(largest, reach[y * tiles.x + x]);
  }
  return largest;
}

/// 0 where `distance` is no nearer than the pixel's own, 1 where it clearly is.
float in_front(float distance, float own) {
  return clamp((own - distance) / (defocus_parting * own), 0.0, 1.0);
}

/// The sample of a circle about a pixel: points of a sunflower (Vogel 1979), turned by noise.
ivec2 circle_point(ivec2 pixel, float radius, uint i, float noise, out float away) {
  away = radius * sqrt((float(i) + noise) / float(defocus_samples));
  float angle = 2.39996323 * float(i) + 6.28318531 * noise;
  vec2 at = vec2(pixel) + 0.5 + away * vec2(cos(angle), sin(angle));
  return clamp(ivec2(floor(at)), ivec2(0), ivec2(frame.extent) - 1);
}

/// Weight of a sample in what lies no nearer than the pixel. What is nearer but behind the focus
/// belongs to it, as far as its own circle reaches.
float weight_behind(float distance, float own, float away) {
  float nearer = in_front(distance, own);
  bool reaches = distance > frame.focus_distance && away <= blur_radius(distance) + smallest_blur;
  return mix(1.0, reaches ? 1.0 : 0.0, nearer);
}

/// Share of the pixel that a sample in front of it and of the focus covers.
float weight_in_front(float distance, float own, float away, float radius) {
  float circle = blur_radius(distance);
  if (distance >= frame.focus_distance || away > circle + smallest_blur) return 0.0;
  float scale = radius / max(circle, 1.0);
  return in_front(distance, own) * scale * scale / float(defocus_samples);
}

mat2x4 behind_and_level(ivec2 pixel, float own, float noise) {
  mat2x4 sum = light_at(pixel);
  float weights = 1.0, away;
  float radius = blur_radius(own);
  for (uint i = 0u; radius > smallest_blur && i < defocus_samples; ++i) {
    ivec2 at = circle_point(pixel, radius, i, noise, away);
    float weight = weight_behind(distance_of(imageLoad(motion, at).w), own, away);
    sum += weight * light_at(at);
    weights += weight;
  }
  return sum / weights;
}

/// @param covered share of the pixel that is covered
mat2x4 front_of(ivec2 pixel, float own, float noise, out float covered) {
  mat2x4 sum = mat2x4(0.0);
  float away;
  float radius = reach_of_front(pixel);
  covered = 0.0;
  for (uint i = 0u; radius > smallest_blur && i < defocus_samples; ++i) {
    ivec2 at = circle_point(pixel, radius, i, noise, away);
    float weight = weight_in_front(distance_of(imageLoad(motion, at).w), own, away, radius);
    if (weight > 0.0) sum += weight * light_at(at);
    covered += weight;
  }
  return covered > 0.0 ? sum / covered : sum;
}

mat2x4 through_lens(ivec2 pixel) {
  float own = distance_of(imageLoad(motion, pixel).w);
  float noise = gradient_noise(pixel), covered;
  mat2x4 front = front_of(pixel, own, noise, covered);
  covered = min(covered, 1.0);
  return (1.0 - covered) * behind_and_level(pixel, own, noise) + covered * front;
}

#endif
