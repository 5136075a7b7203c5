#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Surfaces and indirect light at half the size: of every square of 2x2 pixels the first surface that
// any of them shows, and the mean of the samples that were taken on it.
#include "lib/frame.glsl"
#include "lib/math/octahedral.glsl"
#include "shared/denoise.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, rg32f) readonly uniform image2D depth_slope;
layout(set = 1, binding = 3, r32ui) readonly uniform uimage2D instance;
layout(set = 1, binding = 4, rgba32f) readonly uniform image2D radiance;
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D half_normals;
layout(set = 1, binding = 6, rgba32f) writeonly uniform image2D half_motion;
layout(set = 1, binding = 7, rg32f) writeonly uniform image2D half_slope;
layout(set = 1, binding = 8, r32ui) writeonly uniform uimage2D half_instance;
layout(set = 1, binding = 9, rgba8) writeonly uniform image2D half_surface;
layout(set = 1, binding = 10, rgba32f) writeonly uniform image2D half_radiance;

struct Surface {
  vec4 normals;
  vec4 motion;
  vec2 slope;
  uint instance;
};

bool is_same(Surface s, ivec2 pixel) {
  if (imageLoad(instance, pixel).r != s.instance) return false;
  float allowed =
      half_size_slopes * (abs(s.slope.x) + abs(s.slope.y)) + half_size_depth * s.motion.w;
  if (abs(imageLoad(motion, pixel).w - s.motion.w) > allowed) return false;
  vec3 normal = octahedral_decode(imageLoad(normals, pixel).xy);
  return dot(normal, octahedral_decode(s.normals.xy)) > half_size_cosine;
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(2 * texel)) return;
  Surface s = Surface(vec4(0.0), vec4(0.0), vec2(0.0), 0u);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = 2 * texel + ivec2(i & 1, i >> 1);
    if (outside_frame(pixel)) continue;
    vec4 moved = imageLoad(motion, pixel);
    if (moved.w <= 0.0) continue;
    if (s.motion.w <= 0.0) {
      s = Surface(imageLoad(normals, pixel), moved, imageLoad(depth_slope, pixel).xy,
                  imageLoad(instance, pixel).r);
    } else if (!is_same(s, pixel)) {
      continue;
    }
    vec4 value = imageLoad(radiance, pixel);
    if (value.w >= 0.0) sum += vec4(value.rgb, 1.0);
  }
  imageStore(half_normals, texel, s.normals);
  imageStore(half_motion, texel, s.motion);
  imageStore(half_slope, texel, vec4(2.0 * s.slope, 0.0, 0.0));
  imageStore(half_instance, texel, uvec4(s.instance));
  imageStore(half_surface, texel, vec4(1.0, 0.0, 0.0, 0.0));
  imageStore(half_radiance, texel, vec4(sum.rgb / max(sum.w, 1.0), sum.w > 0.0 ? 1.0 : -1.0));
}
