#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Draws the triangles of few pixels, one in each invocation, and lists the parts of larger ones.
#define DRAWING_GROUP 64
#include "lib/rays/drawn_triangles.glsl"

layout(set = 1, binding = 4, std430) buffer Parts {
  uint part_count;
  DrawnPart parts[];
};
layout(push_constant) uniform Constants {
  uint first_slot;
  uint slots;
  uint most_parts;
};

shared uint group_first;   // of the parts that it lists next
shared uint group_pixels;  // of its largest small triangle

struct Large {
  uint slot;
  Pixels covered;
  Edges edges;
};

/// Those whose samples the triangle may cover; of corners_from_eye().
Pixels covered_pixels(vec3 corners[3]) {
  const float near = shown_near_plane();
  Shown shown = shown_nowhere;
  for (int i = 0; i < 3; ++i) {
    const vec3 from = mat3(frame.view) * corners[i];
    const vec3 to = mat3(frame.view) * corners[(i + 1) % 3];
    include_edge(from, to, near, shown);
  }
  return pixels_of(shown);
}

/// Whether this is a copy: the first leaf that has the triangle draws it.
bool drawn_elsewhere(uint slot) {
  const vec4 first = texelFetch(triangles, int(slot * bvh_texels_per_triangle));
  return (floatBitsToUint(first.w) & bvh_again_bit) != 0u;
}

// Which side of a triangle the camera sees.
const int seen_front = 0;    // or both sides are drawn
const int seen_back = 1;     // is_open() lets rays through
const int seen_edge_on = 2;  // the camera is as near to its plane as the errors of normal and place

/// Of corners_from_eye().
int seen_side(uint slot, vec3 corners[3]) {
  const vec4 second = texelFetch(triangles, int(slot * bvh_texels_per_triangle) + 1);
  if ((floatBitsToUint(second.w) & bvh_one_sided_bit) == 0u) return seen_front;
  const vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const vec3 forward = -frame.inverse_view[2].xyz;
  const vec3 toward = enabled(frame_orthographic) ? forward : corners[0];
  const float place_error = 4e-7 * (length(frame.eye.xyz) + length(corners[0]));
  const float behind = dot(normal, toward);
  const float error = length(normal) * (1.5 * bvh_normal_error * length(toward) + place_error);
  if (abs(behind) <= error) return seen_edge_on;
  return behind > 0.0 ? seen_back : seen_front;
}

// Parts that wait to be listed, so that a group counts them together.
shared DrawnPart part_queue[128];
shared uint parts_queued;

void list_later(uint slot, ivec2 first, ivec2 last) {
  part_queue[atomicAdd(parts_queued, 1u)] = DrawnPart(slot, packed(first), packed(last), 0u);
}

/// By all invocations. `end`: also if there are fewer than invocations.
void list_queued(bool end) {
  barrier();
  const uint count = parts_queued;
  barrier();
  const uint first = count - min(count, 64u);
  if (count >= 64u || end) {
    if (gl_LocalInvocationIndex == 0u) {
      // Once it is too long it grows no more, so that the count never wraps.
      group_first = part_count > most_parts ? most_parts : atomicAdd(part_count, count - first);
      parts_queued = first;
    }
    barrier();
    const uint to = group_first + gl_LocalInvocationIndex;
    const uint own = first + gl_LocalInvocationIndex;
    if (own < count && to < most_parts) parts[to] = part_queue[own];
    barrier();
  }
}

// Triangles of several parts.
shared Large large[64];
shared uint large_count;

/// By all invocations, a part in each.
void list_parts(Large triangle) {
  const int side = int(drawn_part_side);
  const ivec2 corner = triangle.covered.first / side;
  const ivec2 grid = triangle.covered.last / side - corner + 1;
  for (int begin = 0; begin < grid.x * grid.y; begin += 64) {
    const int i = begin + int(gl_LocalInvocationIndex);
    const ivec2 at = (corner + ivec2(i % grid.x, i / grid.x)) * side;
    const ivec2 first = max(triangle.covered.first, at);
    const ivec2 last = min(triangle.covered.last, at + side - 1);
    if (i < grid.x * grid.y && may_cover(triangle.edges, first, last)) {
      list_later(triangle.slot, first, last);
    }
    list_queued(false);
  }
}

/// By all invocations.
void list_large(bool is_large, Large own) {
  const int side = int(drawn_part_side);
  const bool alone = own.covered.first / side == own.covered.last / side;
  if (is_large && alone) list_later(own.slot, own.covered.first, own.covered.last);
  if (is_large && !alone) large[atomicAdd(large_count, 1u)] = own;
  list_queued(false);
  for (uint i = 0u; i < large_count; ++i) list_parts(large[i]);
  list_queued(true);
}

/// By all invocations.
void draw_small(uint slot, Edges edges, Pixels covered) {
  ivec2 pixel = covered.first;
  for (uint i = 0u; i < group_pixels; ++i) {
    if (pixel.y <= covered.last.y && may_cover(edges, pixel)) draw_later(slot, pixel);
    pixel = pixel.x < covered.last.x ? pixel + ivec2(1, 0) : ivec2(covered.first.x, pixel.y + 1);
    draw_queued(false);
  }
  draw_queued(true);
}

void main() {
  uint slot = first_slot + gl_GlobalInvocationID.x;
  Pixels covered = Pixels(ivec2(0), ivec2(-1));
  Edges edges;
  if (gl_GlobalInvocationID.x < slots && !drawn_elsewhere(slot)) {
    const vec3 corners[3] = corners_from_eye(slot);
    const int side = seen_side(slot, corners);
    if (side != seen_back) {
      covered = covered_pixels(corners);
      edges = edges_of(corners);
    }
    if (side == seen_edge_on) slot |= drawn_edge_on_bit;
  }
  const ivec2 size = max(covered.last - covered.first + 1, ivec2(0));
  const uint pixels = uint(size.x) * uint(size.y);
  const bool is_large = pixels > small_triangle_pixels;
  if (gl_LocalInvocationIndex == 0u) {
    parts_queued = 0u;
    large_count = 0u;
    group_pixels = 0u;
  }
  begin_drawing();
  if (!is_large) atomicMax(group_pixels, pixels);
  list_large(is_large, Large(slot, covered, edges));
  if (is_large || pixels == 0u) covered.last.y = -1;
  draw_small(slot, edges, covered);
}
