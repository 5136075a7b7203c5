#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Lists the tiles of 8 x 8 pixels, one in each invocation, that may show what is outside the flat
// tree: boxes of instances on the upper level of the hierarchy, beside the links of its nodes.
#include "lib/rays/shown_pixels.glsl"
#include "shared/bvh.h"
#include "shared/drawn.h"

layout(set = 1, binding = 0) uniform samplerBuffer records;
layout(set = 1, binding = 1, std430) buffer Tiles {
  uint tile_count;
  uint tiles[];
};
layout(set = 1, binding = 2, std430) writeonly buffer Found { uint found_by[]; };
layout(push_constant) uniform Constants {
  uint first_node;
  uint nodes;
};

// With more of them all tiles are listed: every group reads all boxes.
const uint most_nodes = 1024u;

shared Pixels covered[64];  // by the boxes that the group has read
shared uint group_count;
shared uint group_first;

vec3 corner_of(vec2 x, vec2 y, vec2 z, uint corner) {
  return vec3((corner & 1u) != 0u ? x.y : x.x, (corner & 2u) != 0u ? y.y : y.x,
              (corner & 4u) != 0u ? z.y : z.x);
}

Pixels covered_by(vec2 x, vec2 y, vec2 z) {
  const float near = shown_near_plane();
  Shown shown = shown_nowhere;
  for (uint i = 0u; i < 8u; ++i) {
    const vec3 from = mat3(frame.view) * (corner_of(x, y, z, i) - frame.eye.xyz);
    for (uint axis = 1u; axis < 8u; axis *= 2u) {
      const vec3 to = mat3(frame.view) * (corner_of(x, y, z, i ^ axis) - frame.eye.xyz);
      include_edge(from, to, near, shown);
    }
  }
  return pixels_of(shown);
}

/// Of the box beside a link to an instance, unless that is the flat tree. `child`: even numbers are
/// left children.
Pixels covered_by_child(uint child) {
  const Pixels nothing = Pixels(ivec2(0), ivec2(-1));
  if (child >= 2u * nodes) return nothing;
  const int texel = int((first_node + child / 2u) * bvh_texels_per_record);
  const bool right = (child & 1u) != 0u;
  const uvec2 links = floatBitsToUint(texelFetch(records, texel + 3).xy);
  const uint link = right ? links.y : links.x;
  if ((link & bvh_leaf_bit) == 0u) return nothing;
  const int instance = int((link & bvh_leaf_first_mask) * bvh_texels_per_record);
  const uint flat_tree = floatBitsToUint(texelFetch(records, instance + 3).w) & bvh_number_mask;
  if (flat_tree != 0u) return nothing;
  const vec4 xy = texelFetch(records, texel + (right ? 1 : 0));
  const vec4 both_z = texelFetch(records, texel + 2);
  return covered_by(xy.xy, xy.zw, right ? both_z.zw : both_z.xy);
}

/// By all invocations.
bool is_covered(ivec2 first, ivec2 last) {
  if (nodes > most_nodes) return true;
  bool found = false;
  for (uint child = 0u; child < 2u * nodes; child += 64u) {
    covered[gl_LocalInvocationIndex] = covered_by_child(child + gl_LocalInvocationIndex);
    barrier();
    const uint count = min(2u * nodes - child, 64u);
    for (uint i = 0u; i < count; ++i) {
      const Pixels pixels = covered[i];
      found = found || (all(lessThanEqual(pixels.first, last)) &&
                        all(greaterThanEqual(pixels.last, first)));
    }
    barrier();
  }
  return found;
}

void main() {
  if (gl_LocalInvocationIndex == 0u) group_count = 0u;
  barrier();
  const ivec2 first = 8 * ivec2(gl_GlobalInvocationID.xy);
  const bool in_frame = all(lessThan(first, ivec2(frame.extent)));
  const bool listed = is_covered(first, first + 7) && in_frame;
  uint own = 0u;
  if (listed) own = atomicAdd(group_count, 1u);
  barrier();
  if (gl_LocalInvocationIndex == 0u) group_first = atomicAdd(tile_count, group_count);
  barrier();
  const uint tiles_in_row = (frame.extent.x + 7u) / 8u;
  const uint tile = gl_GlobalInvocationID.y * tiles_in_row + gl_GlobalInvocationID.x;
  if (listed) tiles[group_first + own] = tile;
  if (in_frame) found_by[tile] = listed ? tile_drawn_and_traced : tile_drawn;
}
