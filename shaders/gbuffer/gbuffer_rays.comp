#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// A stream of the camera's rays.
#include "lib/rays/gbuffer_ray.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) writeonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) writeonly buffer Rays { StoredRay rays[]; };

void main() {
  uint index = gbuffer_ray_index();
  if (index == 0u) ray_count = full_stream(gl_NumWorkGroups.x * gl_NumWorkGroups.y * 64u, 0u);
  rays[index] = stored(gbuffer_ray(ivec2(gl_GlobalInvocationID.xy)));
}
