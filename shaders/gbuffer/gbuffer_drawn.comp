#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The hits of what was drawn, and of rays to the rest of the scene.
#include "lib/rays/drawn_triangles.glsl"
#include "lib/rays/stored_rays.glsl"

layout(set = 1, binding = 4, std430) readonly buffer Parts { uint part_count; };
layout(set = 1, binding = 5, std430) writeonly buffer Hits { StoredHit hits[]; };
layout(push_constant) uniform Constants {
  uint root;           // of the hierarchy
  uint has_instances;  // beside the triangles that are drawn
  uint most_parts;     // where there were more, not all was drawn
};

void main() {
  const Ray ray = gbuffer_ray(ivec2(gl_GlobalInvocationID.xy));
  const uint index = gbuffer_ray_index();
  const bool drawn = part_count <= most_parts;
  Hit hit = no_hit(ray);
  const uint64_t key = nearest[index];
  if (drawn && key != ~uint64_t(0)) {
    const Line line = make_line(ray.origin, ray.direction);
    vec3 tuv;
    uvec3 words;
    triangle_hit(uint(key), line, vec2(ray.t_min, ray.t_max), tuv, words);
    set_hit(tuv, words, hit);
  }
  if (!drawn || has_instances != 0u) hit = trace_beside(ray, root, 0u, drawn, hit);
  hits[index] = stored(hit);
}
