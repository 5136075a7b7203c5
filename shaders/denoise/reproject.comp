#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Finds every surface in the frame before, once for all signals, and writes what their filters are
// guided by.
#include "lib/frame.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/denoise/packed_guide.glsl"
#include "lib/denoise/reprojection.glsl"
#include "shared/denoise.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 3, rg32f) readonly uniform image2D depth_slope;
layout(set = 1, binding = 4, r32ui) readonly uniform uimage2D instance;
layout(set = 1, binding = 5, rgba32f) readonly uniform image2D previous_normals;
layout(set = 1, binding = 6, rgba32f) readonly uniform image2D previous_motion;
layout(set = 1, binding = 7, r32ui) readonly uniform uimage2D previous_instance;
layout(set = 1, binding = 8, rgba32f) writeonly uniform image2D guide;
layout(set = 1, binding = 9, rgba32f) writeonly uniform image2D reprojection;
layout(set = 1, binding = 10, rg32ui) writeonly uniform uimage2D packed_guide;
layout(set = 1, binding = 11, rg16f) writeonly uniform image2D packed_slope;
layout(push_constant) uniform Constants { ReprojectConstants constants; };

struct Expected {
  vec3 normal;
  float normal_change;
  float view_z;
  vec2 slope;
  float footprint;
  uint instance;
};

vec3 shading_normal(ivec2 pixel) { return octahedral_decode(imageLoad(normals, pixel).xy); }

/// How the normal changes toward the more similar neighbour of each axis: an edge on one side does
/// not loosen the test. Beyond the border the other neighbour stands in.
float normal_change(ivec2 pixel, vec3 normal) {
  ivec2 size = ivec2(frame.extent);
  float change = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    ivec2 step = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
    ivec2 before = inside(pixel - step, size) ? pixel - step : pixel + step;
    ivec2 after = inside(pixel + step, size) ? pixel + step : pixel - step;
    before = clamp(before, ivec2(0), size - 1);
    after = clamp(after, ivec2(0), size - 1);
    change = max(change, min(distance(normal, shading_normal(before)),
                             distance(normal, shading_normal(after))));
  }
  return change;
}

bool is_same(ivec2 pixel, Expected expected) {
  if (!inside(pixel, ivec2(frame.extent))) return false;
  if (imageLoad(previous_instance, pixel).r != expected.instance) return false;
  float previous_z = imageLoad(previous_motion, pixel).w;
  if (!same_depth(expected.view_z, previous_z, expected.slope, expected.footprint,
                  constants.depth_tolerance)) {
    return false;
  }
  vec3 normal = octahedral_decode(imageLoad(previous_normals, pixel).xy);
  return same_normal(expected.normal, normal, expected.normal_change, constants.normal_tolerance);
}

/// xy: where the surface was, pixels; z: which of the four pixels about it still show it; w: 1
/// where none does.
vec4 find(vec2 position, Expected expected) {
  HistoryTaps taps = bilinear_taps(position);
  uint mask = 0u;
  for (int i = 0; i < 4; ++i) {
    if (taps.weights[i] > 0.0 && is_same(taps.base + tap_offset(i), expected)) mask |= 1u << uint(i);
  }
  if (any_tap(valid_taps(taps, mask))) return vec4(position, float(mask), 0.0);
  // The nearest of the 3x3 pixels about it that shows the surface, as an exact position.
  ivec2 center = ivec2(floor(position));
  float nearest = 1e9;
  vec4 result = vec4(position, 0.0, 1.0);
  for (int i = 0; i < 9; ++i) {
    ivec2 pixel = center + ivec2(i % 3, i / 3) - 1;
    vec2 middle = vec2(pixel) + 0.5;
    float separation = distance(middle, position);
    if (separation < nearest && is_same(pixel, expected)) {
      nearest = separation;
      result = vec4(middle, 1.0, 0.0);
    }
  }
  return result;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec4 moved = imageLoad(motion, pixel);
  if (moved.w <= 0.0) {
    imageStore(guide, pixel, vec4(0.0));
    imageStore(packed_guide, pixel, packed_background.xyxy);
    imageStore(packed_slope, pixel, vec4(0.0));
    imageStore(reprojection, pixel, vec4(vec2(pixel) + 0.5, 0.0, 0.0));
    return;
  }
  vec3 normal = shading_normal(pixel);
  vec2 slope = imageLoad(depth_slope, pixel).xy;
  Guide here = Guide(normal, imageLoad(surface, pixel).r, moved.w);
  imageStore(guide, pixel, encode_guide(here));
  imageStore(packed_guide, pixel, pack_guide(here).xyxy);
  imageStore(packed_slope, pixel, pack_slope(slope, moved.w));

  vec4 result = vec4(vec2(pixel) + 0.5, 0.0, 1.0);
  if (frame.history_invalid == 0u) {
    Expected expected;
    expected.normal = normal;
    expected.normal_change = normal_change(pixel, normal);
    expected.view_z = moved.w + moved.z;
    expected.slope = slope;
    expected.footprint = pixel_footprint(expected.view_z);
    expected.instance = imageLoad(instance, pixel).r;
    result = find(vec2(pixel) + 0.5 + moved.xy * vec2(frame.extent), expected);
  }
  imageStore(reprojection, pixel, result);
}
