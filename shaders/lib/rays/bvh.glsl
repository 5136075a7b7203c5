// Walks the two-level hierarchy of shaders/shared/bvh.h. Every lane keeps its own stack.
// Include after defining ANY_HIT as true (whatever is hit first ends it) or false (closest), and
// BVH_BINDING as the first of three bindings of the pass set, for what a tracing::WalkedHierarchy
// has.
#ifndef HELIOGRAPH_LIB_BVH_GLSL
#define HELIOGRAPH_LIB_BVH_GLSL

#include "lib/math/nearest_texel.glsl"
#include "lib/rays/ray_blending.glsl"
#include "shared/bvh.h"
#include "shared/scene.h"

layout(set = 1, binding = BVH_BINDING) uniform samplerBuffer records;
layout(set = 1, binding = BVH_BINDING + 1) uniform samplerBuffer triangles;
layout(set = 1, binding = BVH_BINDING + 2) uniform usamplerBuffer alpha_heap;

// A ray in world or mesh space; t means the same in both.
struct Line {
  vec3 origin;
  vec3 direction;
  vec3 inverse;  // of the direction, finite
  vec3 across;   // two directions that are perpendicular to it
  vec3 down;
};

Line make_line(vec3 origin, vec3 direction) {
  const vec3 sign_or_one = mix(vec3(-1.0), vec3(1.0), greaterThanEqual(direction, vec3(0.0)));
  const vec3 size = abs(direction);
  // Across the axis that it follows least.
  const vec3 across = size.x <= min(size.y, size.z) ? vec3(0.0, -direction.z, direction.y)
                      : size.y <= size.z            ? vec3(direction.z, 0.0, -direction.x)
                                                    : vec3(-direction.y, direction.x, 0.0);
  return Line(origin, direction, sign_or_one / max(size, vec3(1e-20)), across,
              cross(direction, across));
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

uint blending;  // of the ray

// The mask's alpha, of 255, at barycentric (u, v) of a triangle.
uint mask_alpha(uvec4 texels, uvec4 lookup, uint triangle, float u, float v) {
  if (texels.y == 0u) return 255u;
  const int first_uv = int(lookup.z + 2u * triangle);
  const vec4 corners01 = texelFetch(triangles, first_uv);
  const vec2 corner2 = texelFetch(triangles, first_uv + 1).xy;
  const vec2 uv = (1.0 - u - v) * corners01.xy + u * corners01.zw + v * corner2;
  const uint offset = texels.x + nearest_texel(uv, texels.yz, lookup.xy);
  const uint word = texelFetch(alpha_heap, int(offset >> 2)).x;
  return bitfieldExtract(word, int(8u * (offset & 3u)), 8);
}

// Whether the mask lets a ray through barycentric tuv.yz of the triangle end there.
bool mask_stops(uint mask, vec3 tuv, uint instance, uint triangle) {
  const uvec4 texels = record_bits(mask, 0u) & bvh_number_mask;
  const uvec4 lookup = record_bits(mask, 1u) & bvh_number_mask;
  const uint alpha = mask_alpha(texels, lookup, triangle, tuv.y, tuv.z);
  return alpha_stops(alpha, texels.w, blending, instance, triangle);
}

// Where the line sees a place relative to its origin: the line itself lies at 0. Every triangle
// with a corner there gets the same numbers.
vec2 seen_at(vec3 place, Line line) {
  precise const vec2 seen = vec2(dot(place, line.across), dot(place, line.down));
  return seen;
}

// On which side of the edge from a to b, as seen_at(), the line passes: in proportion to the area
// between them. The same edge reversed gives exactly the opposite sign, and rounding is small
// beside a corner that the line just misses, so that it slips through neither between triangles
// nor at their corners (Woop, Benthin and Wald, JCGT 2013).
float side_of_edge(vec2 a, vec2 b) {
  precise const float forth = a.x * b.y;
  precise const float back = a.y * b.x;
  precise const float side = forth - back;
  return side;
}

// Both faces: (t, u, v) where the plane is met, and whether inside. `words`: those beside corners.
bool triangle_hit(uint slot, Line line, vec2 range, out vec3 tuv, out uvec3 words) {
  const int texel = int(slot * bvh_texels_per_triangle);
  const vec4 first = texelFetch(triangles, texel);
  const vec4 second = texelFetch(triangles, texel + 1);
  const vec4 third = texelFetch(triangles, texel + 2);
  words = floatBitsToUint(vec3(first.w, second.w, third.w));
  const vec3 corner0 = first.xyz, corner1 = second.xyz, corner2 = third.xyz;
  const vec3 to_corner0 = corner0 - line.origin;
  const vec2 a = seen_at(to_corner0, line);
  const vec2 b = seen_at(corner1 - line.origin, line);
  const vec2 c = seen_at(corner2 - line.origin, line);
  const vec3 sides = vec3(side_of_edge(b, c), side_of_edge(c, a), side_of_edge(a, b));
  const vec3 normal = cross(corner1 - corner0, corner2 - corner0);
  const float slope = dot(normal, line.direction);
  const float total = sides.x + sides.y + sides.z;
  tuv = vec3(dot(normal, to_corner0) / slope, sides.yz / total);
  const bool inside = all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
  return inside && slope != 0.0 && total != 0.0 && tuv.x > range.x && tuv.x < range.y;
}

// Links still to be visited. Both levels share the stack; bvh_no_link ends each of them.
uint stack[bvh_stack_size];
uint waiting;

void push(uint link) { stack[waiting++] = link; }

uint pop() { return stack[--waiting]; }

// From a node to the next link on the line's way within the range.
uint next_link(uint node, Line line, vec2 range) {
  const int texel = int((node & bvh_number_mask) * bvh_texels_per_record);
  const vec4 left_xy = texelFetch(records, texel);
  const vec4 right_xy = texelFetch(records, texel + 1);
  const vec4 both_z = texelFetch(records, texel + 2);
  const uvec2 children = floatBitsToUint(texelFetch(records, texel + 3).xy);
  const vec2 left = box_interval(left_xy.xy, left_xy.zw, both_z.xy, line, range);
  const vec2 right = box_interval(right_xy.xy, right_xy.zw, both_z.zw, line, range);
  const bool enter_left = left.x <= left.y;
  const bool enter_right = right.x <= right.y;
  // Sorting pays only where a near hit spares the far child.
  const bool right_first = !ANY_HIT && right.x < left.x;
  if (enter_left && enter_right) {
    push(right_first ? children.x : children.y);
    return right_first ? children.y : children.x;
  }
  if (enter_left || enter_right) return enter_left ? children.x : children.y;
  return pop();
}

// Follows the line down to the next leaf that it may meet within the range, or to bvh_no_link.
uint descend(uint link, Line line, vec2 range) {
  while (is_node(link)) link = next_link(link, line, range);
  return link;
}

void set_hit(vec3 tuv, uvec3 words, inout Hit hit) {
  hit.t = tuv.x;
  hit.u = tuv.y;
  hit.v = tuv.z;
  hit.triangle = words.x & bvh_number_mask;
  hit.instance = words.y & bvh_number_mask;
}

// Tests a leaf's triangles up to the first that may be masked away. What remains of the leaf comes
// back as a link: looking up masks between triangles would cost every lane, masked or not.
uint test_leaf(uint link, Line line, float t_min, uvec4 placed, inout Hit hit) {
  uint slot = link & bvh_leaf_first_mask;
  const uint end = slot + ((link >> bvh_leaf_count_shift) & bvh_leaf_count_mask) + 1u;
  const bool in_flat_tree = (placed.w & bvh_number_mask) != 0u;
  bool masked = false;
  vec3 tuv = vec3(0.0);
  uvec3 words = uvec3(0u);
  for (; slot < end && !masked && !(ANY_HIT && hit.instance != hit_none); ++slot) {
    if (!triangle_hit(slot, line, vec2(t_min, hit.t), tuv, words)) continue;
    if (!in_flat_tree) words.yz = placed.yz;
    masked = words.z != bvh_no_link;
    if (!masked) set_hit(tuv, words, hit);
  }
  if (masked && mask_stops(words.z & bvh_number_mask, tuv, words.y & bvh_number_mask,
                           words.x & bvh_number_mask)) {
    set_hit(tuv, words, hit);
  }
  if (slot == end) return pop();
  return bvh_leaf_bit | bvh_number_tag | (end - slot - 1u) << bvh_leaf_count_shift | slot;
}

Line into_mesh(uint record, Line world) {
  const int texel = int(record * bvh_texels_per_record);
  const mat3x4 rows = mat3x4(texelFetch(records, texel), texelFetch(records, texel + 1),
                             texelFetch(records, texel + 2));
  return make_line(vec4(world.origin, 1.0) * rows, vec4(world.direction, 0.0) * rows);
}

Hit no_hit(Ray ray) { return Hit(ray.t_max, hit_none, 0u, 0.0, 0.0, 0u, 0u, 0u); }

// trace(). `without_flat`: the flat tree is left out.
Hit trace_beside(Ray ray, uint root, uint stream_blending, bool without_flat) {
  Hit hit = no_hit(ray);
  if (!(ray.t_min < ray.t_max)) return hit;
  blending = ray_blending(ray, stream_blending);
  const Line world = make_line(ray.origin, ray.direction);
  waiting = 0u;  // whatever the ray before has left
  push(bvh_no_link);
  uint instance_link = root;
  while (true) {
    instance_link = descend(instance_link, world, vec2(ray.t_min, hit.t));
    if (instance_link == bvh_no_link) return hit;
    const uint record = instance_link & bvh_leaf_first_mask;
    const uvec4 placed = record_bits(record, 3u);  // root, instance, mask, flat_tree
    if (without_flat && (placed.w & bvh_number_mask) != 0u) {
      instance_link = pop();
      continue;
    }
    const Line line = into_mesh(record, world);
    push(bvh_no_link);
    uint link = placed.x;
    while (true) {
      link = descend(link, line, vec2(ray.t_min, hit.t));
      if (link == bvh_no_link) break;
      link = test_leaf(link, line, ray.t_min, placed, hit);
      if (ANY_HIT && hit.instance != hit_none) return hit;
    }
    instance_link = pop();
  }
}

// The closest hit, or any if ANY_HIT; hit_none where there is none. `root`: of the hierarchy;
// `stream_blending`: RayCount::blending of the ray's stream.
Hit trace(Ray ray, uint root, uint stream_blending) {
  return trace_beside(ray, root, stream_blending, false);
}

#endif
