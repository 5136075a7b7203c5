#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// What camera rays meet beside what is drawn, in the tiles that may show it, one after the other in
// each group. Where there was no room to draw, all rays are traced through all.
#define ANY_HIT false
#define BVH_BINDING 0
#include "lib/rays/bvh.glsl"
#include "lib/rays/gbuffer_ray.glsl"
#include "lib/rays/stored_rays.glsl"
#include "lib/scene/coverage.glsl"
#include "shared/drawn.h"

layout(set = 1, binding = 3, std430) readonly buffer Parts { uint part_count; };
layout(set = 1, binding = 4, std430) readonly buffer Tiles {
  uint tile_count;
  uint tiles[];
};
layout(set = 1, binding = 5, std430) writeonly buffer Hits { StoredHit hits[]; };
layout(set = 1, binding = 6, std430) writeonly buffer Found { uint found_by[]; };
layout(push_constant) uniform Constants {
  uint root;  // of the hierarchy
  uint most_parts;
};

const int most_passed = 3;  // surfaces; behind more of them another pass traces on

/// The first that the camera sees. `without_flat`: of what is not drawn.
Hit seen_hit(Ray ray, bool without_flat) {
  for (int passed = 0; true; ++passed) {
    const Hit hit = trace_beside(ray, root, 0u, without_flat);
    if (passed == most_passed || hit.instance == hit_none) return hit;
    if (!is_open(hit, ray.direction, cone_width(camera_cone(), hit.t))) return hit;
    ray = beyond(ray, hit);
  }
}

void main() {
  const bool traces_all = part_count > most_parts;
  const uvec2 grid = (frame.extent + 7u) / 8u;
  const uvec2 place = uvec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3u);
  const uint count = traces_all ? grid.x * grid.y : tile_count;
  for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
    const uint tile = traces_all ? i : tiles[i];
    const Ray ray = gbuffer_ray(ivec2(8u * uvec2(tile % grid.x, tile / grid.x) + place));
    hits[tile * tile_pixels + gl_LocalInvocationIndex] = stored(seen_hit(ray, !traces_all));
    if (traces_all && gl_LocalInvocationIndex == 0u) found_by[tile] = tile_traced;
  }
}
