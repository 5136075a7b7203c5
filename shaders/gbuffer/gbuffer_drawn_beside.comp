#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The hits of what was drawn, and of rays to the rest of the scene.
#include "lib/rays/drawn_triangles.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 4, std430) writeonly buffer Hits { StoredHit hits[]; };
layout(push_constant) uniform Constants { uint root; };  // of the hierarchy

void main() {
  const Ray ray = gbuffer_ray(ivec2(gl_GlobalInvocationID.xy));
  const uint index = gbuffer_ray_index();
  hits[index] = stored(trace_beside(ray, root, 0u, true, drawn_hit(index, ray)));
}
