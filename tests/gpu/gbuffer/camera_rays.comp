#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// One ray per pixel, in rows.
#include "lib/rays/camera_ray.glsl"
#include "lib/rays/ray_index.glsl"

layout(set = 1, binding = 0, std430) writeonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) writeonly buffer Rays { Ray rays[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  uint count = frame.extent.x * frame.extent.y;
  if (pixel == ivec2(0)) ray_count = full_stream(count, 0u);
  rays[uint(pixel.y) * frame.extent.x + uint(pixel.x)] = camera_ray(pixel);
}
