#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// One ray through every pixel's sample, tile by tile, so that neighbours in the stream see the same
// part of the scene.
#include "lib/frame.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) writeonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) writeonly buffer Rays { StoredRay rays[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint tiles = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  if (tile == 0u && gl_LocalInvocationIndex == 0u) ray_count = full_stream(tiles * 64u, 0u);
  bool orthographic = enabled(frame_orthographic);
  Ray ray;
  ray.origin = orthographic ? world_position(pixel, 0.0) : frame.eye.xyz;
  ray.direction = -to_eye(pixel);
  // The near plane is what the reversed projection leaves of every point's depth.
  float near_plane = orthographic ? 0.0 : (frame.unjittered * vec4(0.0, 0.0, 0.0, 1.0)).z;
  ray.t_min = near_plane * length(view_position(pixel, 1.0));
  ray.t_max = outside_frame(pixel) ? -1.0 : 1e30;  // of tiles that stick out: an empty interval
  ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
  ray.user = 0u;
  ray.padding0 = 0u;
  ray.padding1 = 0u;
  rays[tile * 64u + gl_LocalInvocationIndex] = stored(ray);
}
