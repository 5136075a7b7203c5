#version 460
#extension GL_GOOGLE_include_directive : require
// Refit, second: the boxes of trees whose triangles have moved, level by level.
#include "shared/bvh.h"
#include "shared/refit.h"

layout(local_size_x = refit_group) in;
layout(set = 1, binding = 0, std430) readonly buffer Triangles { vec4 triangles[]; };
layout(set = 1, binding = 1, std430) readonly buffer Nodes { uint nodes[]; };  // records, by level
layout(set = 1, binding = 2, std430) readonly buffer First { uint first_node[]; };  // of each level
layout(set = 1, binding = 3, std430) coherent buffer Records { BvhNode records[]; };
layout(push_constant) uniform Constants { RefitLevels levels; };

struct Box {
  vec3 low;
  vec3 high;
};

Box box_of_leaf(uint link) {
  uint texel = (link & bvh_leaf_first_mask) * bvh_texels_per_triangle;
  uint count = ((link >> bvh_leaf_count_shift) & bvh_leaf_count_mask) + 1u;
  uint end = texel + count * bvh_texels_per_triangle;
  Box box = Box(triangles[texel].xyz, triangles[texel].xyz);
  for (++texel; texel < end; ++texel) {
    vec3 corner = triangles[texel].xyz;
    box.low = min(box.low, corner);
    box.high = max(box.high, corner);
  }
  return box;
}

Box box_below(uint link) {
  if ((link & bvh_leaf_bit) != 0u) return box_of_leaf(link);
  uint record = link & bvh_number_mask;
  vec4 left = records[record].left_xy, right = records[record].right_xy;
  vec4 z = records[record].both_z;
  return Box(vec3(min(left.xz, right.xz), min(z.x, z.z)),
             vec3(max(left.yw, right.yw), max(z.y, z.w)));
}

void refit(uint record) {
  Box left = box_below(records[record].left), right = box_below(records[record].right);
  records[record].left_xy = vec4(left.low.x, left.high.x, left.low.y, left.high.y);
  records[record].right_xy = vec4(right.low.x, right.high.x, right.low.y, right.high.y);
  records[record].both_z = vec4(left.low.z, left.high.z, right.low.z, right.high.z);
}

void main() {
  uint step = gl_NumWorkGroups.x * refit_group;
  for (uint level = levels.first; level < levels.end; ++level) {
    uint end = first_node[level + 1u];
    for (uint i = first_node[level] + gl_GlobalInvocationID.x; i < end; i += step) refit(nodes[i]);
    memoryBarrierBuffer();
    barrier();
  }
}
