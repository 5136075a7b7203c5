// What the software tracer walks: a two-level hierarchy in uniform texel buffers of four floats.
#ifndef HELIOGRAPH_SHARED_BVH_H
#define HELIOGRAPH_SHARED_BVH_H
#include "types.h"
SHARED_BEGIN

// Whole numbers travel through float texels as bits. With bit 30 set and bit 29 clear they are
// normal floats, which no device flushes to zero or quiets; the lower 29 bits are the number.
SHARED_CONSTANT uint bvh_number_tag = 0x40000000u;
SHARED_CONSTANT uint bvh_number_mask = 0x1fffffffu;

// A link is a number: the index of a record, or, with the sign bit, a leaf: the first triangle in
// the lower 26 bits and the count - 1 in the three above, or on the top level an instance record.
SHARED_CONSTANT uint bvh_leaf_bit = 0x80000000u;
SHARED_CONSTANT uint bvh_leaf_first_mask = 0x03ffffffu;
SHARED_CONSTANT uint bvh_leaf_count_shift = 26u;
SHARED_CONSTANT uint bvh_leaf_count_mask = 7u;
// Beside the number of a triangle: another leaf before has it too, where boxes were split.
SHARED_CONSTANT uint bvh_again_bit = 0x80000000u;
// Beside the number of a triangle's instance: the camera sees it only from where its corners appear
// counter-clockwise. Its normal is right to bvh_normal_error radians.
SHARED_CONSTANT uint bvh_one_sided_bit = 0x80000000u;
SHARED_CONSTANT float bvh_normal_error = 0.004f;
// Nothing: the whole of an empty scene, and what lies at the bottom of the stack.
SHARED_CONSTANT uint bvh_no_link = 0u;

// Most links that wait at any time, both levels together.
SHARED_CONSTANT uint bvh_stack_size = 96u;

SHARED_CONSTANT uint bvh_texels_per_record = 4u;  // node, instance, mask
SHARED_CONSTANT uint bvh_texels_per_triangle = 3u;

// Both children's boxes, so that one fetch decides both (Aila and Laine, HPG 2009).
struct BvhNode {
  vec4 left_xy;  // min x, max x, min y, max y
  vec4 right_xy;
  vec4 both_z;  // left min, left max, right min, right max
  uint left;    // links
  uint right;
  uint padding0;
  uint padding1;
};

// A placed mesh: rows of the matrix world -> mesh.
struct BvhInstance {
  vec4 row0;
  vec4 row1;
  vec4 row2;
  uint root;       // link into the mesh's own hierarchy
  uint instance;   // number: index among the scene's instances
  uint mask;       // number: record of the mesh's alpha mask, or bvh_no_link
  uint flat_tree;  // number, 1: triangles of many instances in world space, which name their own
};

// Where rays pass through a mesh: all numbers.
struct BvhMask {
  uint texels;  // offset in bytes into the alpha heap
  uint width;   // 0: no texture
  uint height;
  uint limit;   // lowest alpha, of 255, that stops a ray; or see mask_blended in ray_mask.h
  uint wrap_s;  // values of wrap_*
  uint wrap_t;
  uint first_uv;  // texel of the triangle buffer: two per triangle of the mesh, uv of its corners
  uint padding[9];
};

// Mesh space, or world space in the flat tree.
struct BvhTriangle {
  vec3 corner0;
  uint triangle;  // number: index within the mesh; in the flat tree perhaps with bvh_again_bit
  vec3 corner1;
  uint instance;  // in the flat tree, number: index among the scene's instances; perhaps with
                  // bvh_one_sided_bit
  vec3 corner2;
  uint mask;  // in the flat tree: as BvhInstance::mask
};

SHARED_END
#endif
