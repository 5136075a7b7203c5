#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Holds the long history of visibility against a short one: what the last few frames show nearby
// bounds it, which 1-sample neighbourhoods could not without cutting rare values away. Where it
// bites the history becomes shorter, so that variance and weights agree with the value. Or, for
// gradient, shortens it by how far the neighbourhood has changed in this frame, which moves the mean
// to neither side.
#include "lib/frame.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/denoise/history_texels.glsl"
#include "lib/denoise/moments.glsl"
#include "lib/denoise/rectification.glsl"
#include "lib/denoise/reprojection.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 1, rg16f) readonly uniform image2D fast;  // or the change
layout(set = 1, binding = 2, rgba32f) uniform image2D signal;
layout(set = 1, binding = 3, rgba16f) uniform image2D history;
layout(set = 1, binding = 4, rgba16) writeonly uniform image2D kept;
layout(push_constant) uniform Constants { TemporalConstants constants; };

/// 0 where no sample was taken.
vec2 known_change(vec2 change) {
  return mix(change, vec2(0.0), equal(change, vec2(change_unknown)));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel) || guide_is_background(imageLoad(guide, pixel))) return;
  Window window = empty_window();
  float surfaces = 0.0;
  for (int y = -constants.radius; y <= constants.radius; ++y) {
    for (int x = -constants.radius; x <= constants.radius; ++x) {
      ivec2 tap = pixel + ivec2(x, y);
      if (!inside(tap, ivec2(frame.extent)) || guide_is_background(imageLoad(guide, tap))) continue;
      surfaces += 1.0;
      vec2 recent = imageLoad(fast, tap).xy;
      if (recent.x == change_unknown && recent.y == change_unknown) continue;
      add(window, vec3(known_change(recent), 0.0));
    }
  }
  vec4 state = imageLoad(history, pixel);
  bool gradient = constants.rectification == rectification_gradient;
  Box box = gradient ? mean_box(window, surfaces, constants.scale,
                                min_sampled_fraction)
                     : widened(variance_box(window, constants.scale), visibility_rounding);
  vec4 value = imageLoad(signal, pixel);
  vec2 held = clamp_to(box, vec3(value.xy, 0.0)).xy;
  vec2 shortened = shortened_history(state.xy, abs(held - value.xy), 0.5 * (box.high - box.low).xy);
  if (gradient) {
    vec2 change = certain_change(box).xy;
    shortened = min(state.xy, vec2(frames_under_motion(change.x), frames_under_motion(change.y)));
    // As if the new sample had come to so short a history.
    vec2 change_here = known_change(imageLoad(fast, pixel).xy);
    vec2 more_weight = 1.0 / max(shortened, vec2(1.0)) - 1.0 / max(state.xy, vec2(1.0));
    held = value.xy + change_here * more_weight;
  }
  vec2 moved = abs(held - value.xy);
  // The variance of the mean grows as the history shrinks.
  if ((constants.flags & temporal_mean_variance) != 0u) {
    value.zw *= state.xy / max(shortened, vec2(1.0));
  }
  imageStore(signal, pixel, vec4(held, value.zw));
  uvec4 rounding = rounding_of(pixel, frame.sample_index);
  imageStore(kept, pixel, as_fractions(vec4(held, value.zw), rounding));
  imageStore(history, pixel, as_halves(vec4(shortened, moved), rounding));
}
