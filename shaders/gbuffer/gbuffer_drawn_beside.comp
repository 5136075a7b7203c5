#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The hits of what was drawn, and of rays to the rest of the scene.
#include "lib/rays/drawn_triangles.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 4, std430) writeonly buffer Hits { StoredHit hits[]; };
layout(push_constant) uniform Constants { uint root; };  // of the hierarchy

const int most_passed = 3;  // surfaces; behind more of them another pass traces on

/// Of what is not drawn: the first that the camera sees in front of `drawn`.
Hit hit_beside(Ray ray, Hit drawn) {
  for (int passed = 0; true; ++passed) {
    const Hit hit = trace_beside(ray, root, 0u, true, drawn);
    if (passed == most_passed || hit.t >= drawn.t) return hit;
    if (!is_open(hit, ray.direction, cone_width(camera_cone(), hit.t))) return hit;
    ray = beyond(ray, hit);
  }
}

void main() {
  const Ray ray = gbuffer_ray(ivec2(gl_GlobalInvocationID.xy));
  const uint index = gbuffer_ray_index();
  hits[index] = stored(hit_beside(ray, drawn_hit(index, ray)));
}
