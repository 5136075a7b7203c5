// Which pixels of the frame may show an edge of something in the world.
#ifndef HELIOGRAPH_SHOWN_PIXELS_GLSL
#define HELIOGRAPH_SHOWN_PIXELS_GLSL
#include "lib/rays/gbuffer_ray.glsl"

/// A rectangle of pixels; empty where `last` is less than `first`.
struct Pixels {
  ivec2 first;
  ivec2 last;
};

/// The corners of a rectangle on the image, in pixels: whole numbers are their samples. Empty where
/// `high` is less than `low`.
struct Shown {
  vec2 low;
  vec2 high;
};

const Shown shown_nowhere = Shown(vec2(1e30), vec2(-1e30));

/// By how many pixels the rays of a pixel may miss its sample. An orthographic camera's begin at
/// places in the world, which far from the origin have few digits left.
float shown_slack() {
  if (!enabled(frame_orthographic)) return 0.05;
  const vec3 far = abs(frame.eye.xyz);
  return 0.05 + 2e-6 * max(far.x, max(far.y, far.z)) / pixel_footprint(1.0);
}

/// Where nothing is cut off: how far before the camera, metres.
float shown_near_plane() { return enabled(frame_orthographic) ? -1e30 : camera_near_plane(); }

/// Where the camera shows a place in view space.
vec2 shown_at(vec3 view) {
  const vec2 slope = enabled(frame_orthographic) ? view.xy : view.xy / -view.z;
  const vec2 ndc = (slope - frame.unproject.zw) / frame.unproject.xy;
  return (0.5 + 0.5 * ndc) * vec2(frame.extent) - 0.5;
}

void include(vec2 at, inout Shown shown) {
  shown.low = min(shown.low, at);
  shown.high = max(shown.high, at);
}

/// With the edge between two places in view space, but for `to`, which begins another edge.
void include_edge(vec3 from, vec3 to, float near, inout Shown shown) {
  const bool in_front = -from.z >= near;
  if (in_front) include(shown_at(from), shown);
  if (in_front == (-to.z >= near)) return;
  vec3 cut = mix(from, to, (near + from.z) / (from.z - to.z));
  cut.z = -near;
  const vec2 at = shown_at(cut);
  // Rounding of the cut, as a slope.
  const float off = 2e-7 * length(to - from) / (near * pixel_footprint(1.0));
  include(at - off, shown);
  include(at + off, shown);
}

/// Those whose rays may meet what is shown there.
Pixels pixels_of(Shown shown) {
  const float slack = shown_slack();
  const vec2 end = vec2(frame.extent);
  return Pixels(
      max(ivec2(ceil(clamp(shown.low - slack, vec2(-1.0), end))), ivec2(0)),
      min(ivec2(floor(clamp(shown.high + slack, vec2(-1.0), end))), ivec2(frame.extent) - 1));
}

#endif
