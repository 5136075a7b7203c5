// Walks the two-level hierarchy of shaders/shared/bvh.h. Every lane keeps its own stack.
// Include after defining ANY_HIT as true (whatever is hit first ends it) or false (closest).
#ifndef HELIOGRAPH_LIB_BVH_GLSL
#define HELIOGRAPH_LIB_BVH_GLSL

#include "shared/bvh.h"
#include "shared/ray.h"
#include "shared/scene.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2) uniform samplerBuffer records;
layout(set = 1, binding = 3) uniform samplerBuffer triangles;
layout(set = 1, binding = 4) uniform usamplerBuffer alpha_heap;

layout(push_constant) uniform Constants { uint root; };

// A ray in world or mesh space; t means the same in both.
struct Line {
  vec3 origin;
  vec3 direction;
  vec3 inverse;  // of the direction, finite
};

Line make_line(vec3 origin, vec3 direction) {
  const vec3 sign_or_one = mix(vec3(-1.0), vec3(1.0), greaterThanEqual(direction, vec3(0.0)));
  return Line(origin, direction, sign_or_one / max(abs(direction), vec3(1e-20)));
}

bool is_node(uint link) { return link != bvh_no_link && (link & bvh_leaf_bit) == 0u; }

uvec4 record_bits(uint record, uint texel) {
  return floatBitsToUint(texelFetch(records, int(record * bvh_texels_per_record + texel)));
}

// Entry and exit of a box; exits are widened so that rounding never misses it (Ize, JCGT 2013).
vec2 box_interval(vec2 x, vec2 y, vec2 z, Line line, vec2 range) {
  x = (x - line.origin.x) * line.inverse.x;
  y = (y - line.origin.y) * line.inverse.y;
  z = (z - line.origin.z) * line.inverse.z;
  const float near = max(max(min(x.x, x.y), min(y.x, y.y)), max(min(z.x, z.y), range.x));
  const float far = min(min(max(x.x, x.y), max(y.x, y.y)), min(max(z.x, z.y), range.y));
  return vec2(near, far * 1.0000004);
}

// Into 0..1; the same as wrap() in server/tracing/alpha_mask.cpp.
float wrap(float coordinate, uint mode) {
  if (mode == wrap_clamp) return clamp(coordinate, 0.0, 1.0);
  if (mode == wrap_mirror) {
    return 1.0 - abs(coordinate - 2.0 * floor(0.5 * coordinate) - 1.0);
  }
  return coordinate - floor(coordinate);
}

// Whether the mask lets a ray through barycentric (u, v) of the triangle at `place` end there.
bool mask_stops(uint mask, uint place, float u, float v) {
  const uvec4 texels = record_bits(mask, 0u) & bvh_number_mask;
  const uvec4 lookup = record_bits(mask, 1u) & bvh_number_mask;
  const uvec2 size = texels.yz;
  const uint threshold = texels.w;
  const int first_uv = int(lookup.z + 2u * (place - lookup.w));
  const vec4 corners01 = texelFetch(triangles, first_uv);
  const vec2 corner2 = texelFetch(triangles, first_uv + 1).xy;
  const vec2 uv = (1.0 - u - v) * corners01.xy + u * corners01.zw + v * corner2;
  const vec2 wrapped = vec2(wrap(uv.x, lookup.x), wrap(uv.y, lookup.y));
  const uvec2 texel = min(uvec2(wrapped * vec2(size)), size - 1u);
  const uint offset = texels.x + texel.y * size.x + texel.x;
  const uint word = texelFetch(alpha_heap, int(offset >> 2)).x;
  return bitfieldExtract(word, int(8u * (offset & 3u)), 8) >= threshold;
}

// Möller and Trumbore (1997), both faces: (t, u, v) of the plane's point, and whether it is inside.
bool triangle_hit(uint place, Line line, vec2 range, out vec3 tuv, out uint triangle) {
  const int texel = int(place * bvh_texels_per_triangle);
  const vec4 corner = texelFetch(triangles, texel);
  const vec3 edge1 = texelFetch(triangles, texel + 1).xyz;
  const vec3 edge2 = texelFetch(triangles, texel + 2).xyz;
  triangle = floatBitsToUint(corner.w) & bvh_number_mask;
  const vec3 p = cross(line.direction, edge2);
  const float determinant = dot(edge1, p);
  const float scale = 1.0 / determinant;
  const vec3 s = line.origin - corner.xyz;
  const vec3 q = cross(s, edge1);
  tuv = scale * vec3(dot(edge2, q), dot(s, p), dot(line.direction, q));
  return determinant != 0.0 && tuv.y >= 0.0 && tuv.z >= 0.0 && tuv.y + tuv.z <= 1.0 &&
         tuv.x > range.x && tuv.x < range.y;
}

Hit trace(Ray ray) {
  Hit hit;
  hit.t = ray.t_max;
  hit.instance = hit_none;
  hit.triangle = 0u;
  hit.u = hit.v = 0.0;
  hit.padding0 = hit.padding1 = hit.padding2 = 0u;

  const Line world = make_line(ray.origin, ray.direction);
  Line line = world;
  uint stack[bvh_stack_size];
  stack[0] = bvh_no_link;
  uint waiting = 1u;
  bool in_mesh = false;
  uvec3 placed = uvec3(0u);  // root, instance, mask of the mesh the ray is in
  uint link = ray.t_min < ray.t_max ? root : bvh_no_link;

  while (link != bvh_no_link || in_mesh) {
    while (is_node(link)) {
      const int texel = int((link & bvh_number_mask) * bvh_texels_per_record);
      const vec4 left_xy = texelFetch(records, texel);
      const vec4 right_xy = texelFetch(records, texel + 1);
      const vec4 both_z = texelFetch(records, texel + 2);
      const uvec2 children = floatBitsToUint(texelFetch(records, texel + 3).xy);
      const vec2 range = vec2(ray.t_min, hit.t);
      const vec2 left = box_interval(left_xy.xy, left_xy.zw, both_z.xy, line, range);
      const vec2 right = box_interval(right_xy.xy, right_xy.zw, both_z.zw, line, range);
      const bool enter_left = left.x <= left.y;
      const bool enter_right = right.x <= right.y;
      const bool swapped = !ANY_HIT && right.x < left.x;
      if (enter_left && enter_right) {
        stack[waiting++] = swapped ? children.x : children.y;
        link = swapped ? children.y : children.x;
      } else if (enter_left || enter_right) {
        link = enter_left ? children.x : children.y;
      } else {
        link = stack[--waiting];
      }
    }
    if (link == bvh_no_link) {
      if (!in_mesh) break;
      in_mesh = false;
      line = world;
      link = stack[--waiting];
    } else if (!in_mesh) {
      const uint record = link & bvh_leaf_first_mask;
      placed = record_bits(record, 3u).xyz;
      const int texel = int(record * bvh_texels_per_record);
      const vec4 row0 = texelFetch(records, texel);
      const vec4 row1 = texelFetch(records, texel + 1);
      const vec4 row2 = texelFetch(records, texel + 2);
      const vec4 origin = vec4(world.origin, 1.0);
      line = make_line(vec3(dot(row0, origin), dot(row1, origin), dot(row2, origin)),
                       vec3(dot(row0.xyz, world.direction), dot(row1.xyz, world.direction),
                            dot(row2.xyz, world.direction)));
      stack[waiting++] = bvh_no_link;
      link = placed.x;
      in_mesh = true;
    } else {
      uint place = link & bvh_leaf_first_mask;
      const uint end = place + ((link >> bvh_leaf_count_shift) & bvh_leaf_count_mask) + 1u;
      for (; place < end; ++place) {
        vec3 tuv;
        uint triangle;
        if (!triangle_hit(place, line, vec2(ray.t_min, hit.t), tuv, triangle)) continue;
        if (placed.z != bvh_no_link &&
            !mask_stops(placed.z & bvh_number_mask, place, tuv.y, tuv.z)) {
          continue;
        }
        hit.t = tuv.x;
        hit.u = tuv.y;
        hit.v = tuv.z;
        hit.instance = placed.y & bvh_number_mask;
        hit.triangle = triangle;
        if (ANY_HIT) return hit;
      }
      link = stack[--waiting];
    }
  }
  return hit;
}

#endif
