#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// What gbuffer_first_drawn.comp takes for the hits of camera rays, and how they were found.
#define BVH_BINDING 0
#define DRAWN_BINDING 3
#include "lib/rays/drawn_hit.glsl"
#include "lib/rays/gbuffer_ray.glsl"

layout(set = 1, binding = 6, std430) writeonly buffer Hits { Hit hits[]; };

void main() {
  const uint index = gbuffer_ray_index();
  hits[index] = drawn_hit(index, gbuffer_ray(ivec2(gl_GlobalInvocationID.xy)));
  hits[index].padding0 = found_by[index / 64u];
}
