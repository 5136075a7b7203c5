#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
layout(local_size_x = 64) in;

#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 5, std430) writeonly buffer Hits { StoredHit hits[]; };
layout(push_constant) uniform Constants { uint root; };

#define ANY_HIT false
#define BVH_BINDING 2
#include "lib/rays/bvh_together.glsl"

void main() {
  const uint index = traced_ray(ray_count.count);
  trace_together(index, root);
  if (index != not_traced) hits[index] = stored(hit_of[gl_LocalInvocationIndex]);
}
