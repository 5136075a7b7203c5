// The camera rays that find the G-buffer: one through every pixel's sample, tile by tile, so that
// neighbours in the stream see the same part of the scene.
#ifndef HELIOGRAPH_GBUFFER_RAY_GLSL
#define HELIOGRAPH_GBUFFER_RAY_GLSL
#include "lib/frame.glsl"
#include "shared/ray.h"

/// Of this invocation's ray, in groups of 8 x 8 invocations, one for each pixel.
uint gbuffer_ray_index() {
  uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  return tile * 64u + gl_LocalInvocationIndex;
}

/// Of a perspective view, metres: what the reversed projection leaves of every point's depth.
float camera_near_plane() { return (frame.unjittered * vec4(0.0, 0.0, 0.0, 1.0)).z; }

/// Blended surfaces stop it: RayCount::blending of its stream is 0.
Ray gbuffer_ray(ivec2 pixel) {
  bool orthographic = enabled(frame_orthographic);
  Ray ray;
  ray.origin = orthographic ? world_position(pixel, 0.0) : frame.eye.xyz;
  ray.direction = -to_eye(pixel);
  float near_plane = orthographic ? 0.0 : camera_near_plane();
  ray.t_min = near_plane * length(view_position(pixel, 1.0));
  ray.t_max = outside_frame(pixel) ? -1.0 : 1e30;  // of tiles that stick out: an empty interval
  ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
  ray.user = 0u;
  ray.padding0 = 0u;
  ray.padding1 = 0u;
  return ray;
}

#endif
