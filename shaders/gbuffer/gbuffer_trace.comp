#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// What the camera's rays meet first. Each is made where it is traced: none is stored.
#define ANY_HIT false
#define BVH_BINDING 0
#include "lib/rays/bvh.glsl"
#include "lib/rays/gbuffer_ray.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 3, std430) writeonly buffer Hits { StoredHit hits[]; };
layout(push_constant) uniform Constants { uint root; };

void main() {
  const Ray ray = gbuffer_ray(ivec2(gl_GlobalInvocationID.xy));
  hits[gbuffer_ray_index()] = stored(trace(ray, root, 0u));
}
