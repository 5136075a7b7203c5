#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
// Holds the long history of reflections against a short one: what the last few frames show nearby
// bounds it, which 1-sample neighbourhoods could not without cutting rare bright paths away (the
// "holes" of paper section 3.1). Where it bites the history becomes shorter, so that variance and
// weights agree with the colour. Or, for gradient, shortens it by how far the neighbourhood's
// brightness has changed in this frame.
#include "lib/frame.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/denoise/history_texels.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/denoise/rectification.glsl"
#include "lib/denoise/reprojection.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 1, rgba16f) readonly uniform image2D fast;  // or the change, w < 0: none
layout(set = 1, binding = 2, rgba32f) uniform image2D signal;
layout(set = 1, binding = 3, rgba16f) uniform image2D history;
layout(set = 1, binding = 4, rgba16f) writeonly uniform image2D kept;  // radiance, distance
layout(push_constant) uniform Constants { TemporalConstants constants; };

const int group_side = 16;
const int most_radius = 8;  // of settings
const int most_side = group_side + 2 * most_radius;
const float no_surface = -1.0, unsampled = 0.0, sampled = 1.0;
// YCoCg of `fast`; a: one of the above. Then, for every row of the group, the sums of the columns
// beside each other: two texels each, with colours and how many were sampled, and with squares and
// how many show a surface.
shared vec4 nearby[most_side * most_side];

/// What the windows of a group cover, read once.
void read_nearby(bool gradient) {
  int side = group_side + 2 * constants.radius;
  ivec2 corner = ivec2(gl_WorkGroupID.xy) * group_side - constants.radius;
  for (int i = int(gl_LocalInvocationIndex); i < side * side; i += group_side * group_side) {
    ivec2 tap = corner + ivec2(i % side, i / side);
    vec4 recent = vec4(0.0, 0.0, 0.0, no_surface);
    if (inside(tap, ivec2(frame.extent)) && !guide_is_background(imageLoad(guide, tap))) {
      recent = imageLoad(fast, tap);
      recent = vec4(to_ycocg(recent.rgb), gradient && recent.w < 0.0 ? unsampled : sampled);
    }
    nearby[i] = recent;
  }
  barrier();
}

const int group_threads = group_side * group_side;
const int most_sums = (most_side * group_side + group_threads - 1) / group_threads;  // of a thread

/// Adds up the columns of all windows, which rows of windows share.
void sum_columns(int side) {
  vec4 colors[most_sums], squares[most_sums];
  for (int k = 0; k < most_sums; ++k) {
    colors[k] = squares[k] = vec4(0.0);
    int i = int(gl_LocalInvocationIndex) + k * group_threads;
    if (i >= side * group_side) break;
    for (int y = 0; y <= 2 * constants.radius; ++y) {
      vec4 recent = nearby[i + y * side];
      if (recent.a == no_surface) continue;
      squares[k].a += 1.0;
      if (recent.a != sampled) continue;
      colors[k] += vec4(recent.rgb, 1.0);
      squares[k].rgb += recent.rgb * recent.rgb;
    }
  }
  barrier();
  for (int k = 0; k < most_sums; ++k) {
    int i = int(gl_LocalInvocationIndex) + k * group_threads;
    if (i >= side * group_side) break;
    nearby[2 * i] = colors[k];
    nearby[2 * i + 1] = squares[k];
  }
  barrier();
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool gradient = constants.rectification == rectification_gradient;
  read_nearby(gradient);
  int side = group_side + 2 * constants.radius;
  int first = int(gl_LocalInvocationID.y) * side + int(gl_LocalInvocationID.x);
  bool has_surface = nearby[first + constants.radius * (side + 1)].a != no_surface;
  sum_columns(side);
  if (!has_surface) return;
  vec4 colors = vec4(0.0), squares = vec4(0.0);
  for (int x = 0; x <= 2 * constants.radius; ++x) {
    colors += nearby[2 * (first + x)];
    squares += nearby[2 * (first + x) + 1];
  }
  Window window = Window(Box(vec3(0.0), vec3(0.0)), colors.rgb, squares.rgb, colors.a);
  float surfaces = squares.a;
  vec4 state = imageLoad(history, pixel);
  vec4 value = imageLoad(signal, pixel);
  float bright = window.sum.x / max(window.count, 1.0);
  Box box = gradient ? mean_box(window, surfaces, constants.scale,
                                min_sampled_fraction_specular)
                     : widened(variance_box(window, constants.scale), specular_rounding * bright);
  vec3 color = to_ycocg(value.rgb);
  vec3 held = clamp_to(box, color);
  float moved = abs(held.x - color.x);
  vec4 recent_here = imageLoad(fast, pixel);
  float frames = shortened_history(state.xx, vec2(moved), vec2(0.5 * (box.high.x - box.low.x))).x;
  if (gradient) {
    float change = certain_change(box).x;
    frames = min(state.x, frames_under_motion(change / (abs(color.x) + change + 1e-4)));
    vec3 sampled = to_ycocg(recent_here.rgb);
    // As if the new sample had come to so short a history.
    held = color + sampled * (1.0 / max(frames, 1.0) - 1.0 / max(state.x, 1.0));
    moved = abs(held.x - color.x);
  }
  // The variance of the mean grows as the history shrinks.
  if ((constants.flags & temporal_mean_variance) != 0u) value.w *= state.x / max(frames, 1.0);
  vec3 radiance = from_ycocg(held);
  uvec4 rounding = rounding_of(pixel, frame.sample_index);
  imageStore(signal, pixel, vec4(radiance, value.w));
  imageStore(kept, pixel, as_halves(vec4(radiance, recent_here.w), rounding));
  imageStore(history, pixel, as_halves(vec4(frames, moved, state.zw), rounding));
}
