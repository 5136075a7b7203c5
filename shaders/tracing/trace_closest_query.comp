#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
layout(local_size_x = 64) in;

#include "lib/rays/ray_query.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 6, std430) writeonly buffer Hits { StoredHit hits[]; };

void main() {
  const uint index = ray_index();
  if (index >= ray_count.count) return;
  hits[index] = stored(trace(rays[index], gl_RayFlagsNoneEXT));
}
