// What camera rays meet first, by drawing: where a triangle covers a pixel, it is intersected with
// that pixel's ray, and the nearest of all stays. Binding 3 of the pass set is the nearest.
#ifndef HELIOGRAPH_DRAWN_TRIANGLES_GLSL
#define HELIOGRAPH_DRAWN_TRIANGLES_GLSL
#extension GL_EXT_shader_atomic_int64 : require
#define ANY_HIT false
#define BVH_BINDING 0
#include "lib/rays/bvh.glsl"
#include "lib/rays/drawn_key.glsl"
#include "lib/rays/shown_pixels.glsl"
#include "lib/scene/coverage.glsl"
#include "shared/drawn.h"

layout(set = 1, binding = 3, std430) buffer Nearest { uint64_t nearest[]; };

/// gbuffer_ray_index() of the invocation of that pixel.
uint drawn_index(uvec2 pixel) {
  uint tiles_in_row = (frame.extent.x + 7u) / 8u;
  uint tile = (pixel.y >> 3u) * tiles_in_row + (pixel.x >> 3u);
  return tile * 64u + (pixel.y & 7u) * 8u + (pixel.x & 7u);
}

/// Relative to the eye: places far from the origin keep their digits.
vec3[3] corners_from_eye(uint slot) {
  const int texel = int(slot * bvh_texels_per_triangle);
  return vec3[3](texelFetch(triangles, texel).xyz - frame.eye.xyz,
                 texelFetch(triangles, texel + 1).xyz - frame.eye.xyz,
                 texelFetch(triangles, texel + 2).xyz - frame.eye.xyz);
}

// On which side of each edge a pixel lies: at + across x + down y, which is negative outside, but for
// shown_slack(), so that rounding takes nothing away. Also of triangles that reach behind the camera
// (Olano and Greer, Graphics Hardware 1997).
struct Edges {
  vec3 at;
  vec3 across;
  vec3 down;
};

/// Of corners_from_eye(): along the world's axes, which walls and floors follow, so that little is
/// lost by rounding.
Edges edges_of(vec3 corners[3]) {
  const mat3 view = mat3(frame.view);
  const vec2 step = 2.0 * frame.unproject.xy / vec2(frame.extent);
  const vec2 origin = 0.5 * step - frame.unproject.xy + frame.unproject.zw;
  const bool orthographic = enabled(frame_orthographic);
  const vec3 normal_of_all = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const float toward = orthographic ? (view * normal_of_all).z : dot(normal_of_all, corners[0]);
  const float turn = toward < 0.0 ? -1.0 : 1.0;
  Edges edges;
  for (int i = 0; i < 3; ++i) {
    const vec3 from = corners[i];
    const vec3 along = turn * (corners[(i + 1) % 3] - from);
    // Times (x, y, 1) of a slope, or of a place on the image plane.
    vec3 normal = view * cross(from, along) * vec3(1.0, 1.0, -1.0);
    if (orthographic) {
      const vec2 start = (view * from).xy;
      const vec2 shown = (view * along).xy;
      normal = vec3(-shown.y, shown.x, shown.y * start.x - shown.x * start.y);
    }
    edges.across[i] = normal.x * step.x;
    edges.down[i] = normal.y * step.y;
    // Rounding is large beside the result where both corners lie in nearly the same direction.
    edges.at[i] = normal.x * origin.x + normal.y * origin.y + normal.z +
                  1e-6 * length(from) * length(along);
  }
  edges.at += shown_slack() * (abs(edges.across) + abs(edges.down));
  return edges;
}

/// Whether the triangle may cover a pixel of the rectangle.
bool may_cover(Edges edges, ivec2 first, ivec2 last) {
  const vec3 most = edges.at + max(edges.across * float(first.x), edges.across * float(last.x)) +
                    max(edges.down * float(first.y), edges.down * float(last.y));
  return all(greaterThanEqual(most, vec3(0.0)));
}

bool may_cover(Edges edges, ivec2 pixel) { return may_cover(edges, pixel, pixel); }

// Beside the slot of a triangle that the camera sees nearly edge on: which side a ray meets is told
// by the hit alone.
const uint drawn_edge_on_bit = 0x80000000u;

void draw_pixel(uint slot_and_bit, ivec2 pixel) {
  const uint slot = slot_and_bit & ~drawn_edge_on_bit;
  const Ray ray = gbuffer_ray(pixel);
  const Line line = make_line(ray.origin, ray.direction);
  vec3 tuv;
  uvec3 words;
  if (!triangle_hit(slot, line, vec2(ray.t_min, ray.t_max), tuv, words)) return;
  const uint64_t key = drawn_key(tuv.x, slot);
  const uint index = drawn_index(uvec2(pixel));
  // Reading costs less, and most of what lies behind ends here.
  if (key >= nearest[index]) return;
  const uvec3 numbers = words & bvh_number_mask;
  blending = 0u;  // blended surfaces stop the ray
  const bool masked = words.z != bvh_no_link;
  if (masked && !mask_stops(numbers.z, tuv, numbers.y, numbers.x)) return;
  if (masked || slot != slot_and_bit) {
    Hit hit = no_hit(ray);
    set_hit(tuv, words, hit);
    if (is_open(hit, ray.direction, cone_width(camera_cone(), hit.t))) return;
  }
  atomicMin(nearest[index], key);
}

#ifdef DRAWING_GROUP
// Few pixels of a triangle's rectangle are covered: those that are wait until there is one for every
// invocation of the group, of which there are DRAWING_GROUP.
shared uvec2 queue[2 * DRAWING_GROUP];
shared uint queued;

uint packed(ivec2 pixel) { return uint(pixel.x) | uint(pixel.y) << 16u; }

ivec2 unpacked(uint pixel) { return ivec2(pixel & 0xffffu, pixel >> 16u); }

void begin_drawing() {
  if (gl_LocalInvocationIndex == 0u) queued = 0u;
  barrier();
}

/// Once in each invocation, if at all, before draw_queued().
void draw_later(uint slot, ivec2 pixel) {
  queue[atomicAdd(queued, 1u)] = uvec2(slot, packed(pixel));
}

/// By all invocations. `end`: also if there are fewer than invocations.
void draw_queued(bool end) {
  barrier();
  const uint count = queued;
  barrier();
  const uint first = count - min(count, uint(DRAWING_GROUP));
  if (count >= DRAWING_GROUP || end) {
    const uint own = first + gl_LocalInvocationIndex;
    if (own < count) draw_pixel(queue[own].x, unpacked(queue[own].y));
    barrier();
    if (gl_LocalInvocationIndex == 0u) queued = first;
    barrier();
  }
}
#endif

#endif
