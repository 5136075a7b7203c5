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

// Comparisons, since min() and max() may return what is no number.
void include(inout Box box, vec3 low, vec3 high) {
  box.low = mix(box.low, low, lessThan(low, box.low));
  box.high = mix(box.high, high, greaterThan(high, box.high));
}

Box box_below(uint link) {
  Box box = Box(vec3(refit_empty), vec3(-refit_empty));
  if ((link & bvh_leaf_bit) != 0u) {
    uint texel = (link & bvh_leaf_first_mask) * bvh_texels_per_triangle;
    uint count = ((link >> bvh_leaf_count_shift) & bvh_leaf_count_mask) + 1u;
    uint end = texel + count * bvh_texels_per_triangle;
    for (; texel < end; ++texel) include(box, triangles[texel].xyz, triangles[texel].xyz);
    return box;
  }
  uint record = link & bvh_number_mask;
  vec4 left = records[record].left_xy, right = records[record].right_xy;
  vec4 z = records[record].both_z;
  include(box, vec3(left.xz, z.x), vec3(left.yw, z.y));
  include(box, vec3(right.xz, z.z), vec3(right.yw, z.w));
  return box;
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
