#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
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

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel) || guide_is_background(imageLoad(guide, pixel))) return;
  bool gradient = constants.rectification == rectification_gradient;
  Window window = empty_window();
  float surfaces = 0.0;
  for (int y = -constants.radius; y <= constants.radius; ++y) {
    for (int x = -constants.radius; x <= constants.radius; ++x) {
      ivec2 tap = pixel + ivec2(x, y);
      if (!inside(tap, ivec2(frame.extent)) || guide_is_background(imageLoad(guide, tap))) continue;
      surfaces += 1.0;
      vec4 recent = imageLoad(fast, tap);
      if (gradient && recent.w < 0.0) continue;
      add(window, to_ycocg(recent.rgb));
    }
  }
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
