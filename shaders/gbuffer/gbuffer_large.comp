#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 32) in;
// Draws the parts of large triangles, each by a group.
#define DRAWING_GROUP 32
#include "lib/rays/drawn_triangles.glsl"

layout(set = 1, binding = 4, std430) readonly buffer Parts {
  uint part_count;
  DrawnPart parts[];
};
layout(push_constant) uniform Constants { uint most_parts; };

/// By all invocations.
void draw_part(DrawnPart part) {
  const ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3u);
  const ivec2 first = unpacked(part.first);
  const ivec2 last = unpacked(part.last);
  const Edges edges = edges_of(corners_from_eye(part.slot & ~drawn_edge_on_bit));
  for (int y = first.y; y <= last.y; y += 4) {
    for (int x = first.x; x <= last.x; x += 8) {
      if (!may_cover(edges, ivec2(x, y), ivec2(x + 7, y + 3))) continue;
      const ivec2 pixel = ivec2(x, y) + lane;
      if (all(lessThanEqual(pixel, last)) && may_cover(edges, pixel)) draw_later(part.slot, pixel);
      draw_queued(false);
    }
  }
}

void main() {
  begin_drawing();
  if (part_count > most_parts) return;  // gbuffer_beside.comp traces all
  for (uint i = gl_WorkGroupID.x; i < part_count; i += gl_NumWorkGroups.x) draw_part(parts[i]);
  draw_queued(true);
}
