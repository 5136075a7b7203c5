#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Visibility and what guides its blur at half the size: every texel is the mean of those pixels of
// a square of 2x2 that show the same surface as the first that shows any.
#include "lib/denoise/edge_stopping.glsl"
#include "lib/denoise/packed_guide.glsl"
#include "lib/frame.glsl"
#include "shared/denoise.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 1, rg32f) readonly uniform image2D depth_slope;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D signal;
layout(set = 1, binding = 3, rgba32f) writeonly uniform image2D half_guide;
layout(set = 1, binding = 4, rg32f) writeonly uniform image2D half_slope;
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D half_signal;
layout(set = 1, binding = 6, rg32ui) writeonly uniform uimage2D packed_guide;
layout(set = 1, binding = 7, rg16f) writeonly uniform image2D packed_slope;
layout(push_constant) uniform Constants { AtrousConstants constants; };

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 corner = 2 * texel;
  if (outside_frame(corner)) return;
  vec4 first = vec4(0.0);
  vec2 slope = vec2(0.0);
  ivec2 place;
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = corner + ivec2(i & 1, i >> 1);
    if (outside_frame(pixel)) continue;
    vec4 guide_q = imageLoad(guide, pixel);
    if (guide_is_background(guide_q)) continue;
    float weight = 1.0;
    if (total == 0.0) {
      first = guide_q;
      slope = imageLoad(depth_slope, pixel).xy;
      place = pixel;
    } else {
      Guide p = decode_guide(first), q = decode_guide(guide_q);
      vec2 offset = vec2(pixel - place);
      float curve = enabled(frame_orthographic) ? 0.0 : 1.0 / p.view_z;
      weight = edge_weight(
          depth_exponent(plane_distance(p.view_z, slope, curve, q.view_z, offset),
                         depth_allowance(slope, offset, pixel_footprint(p.view_z)),
                         constants.depth_sigma) +
          normal_exponent(dot(p.normal, q.normal), constants.normal_power));
    }
    sum += vec4(vec2(weight), vec2(weight * weight)) * imageLoad(signal, pixel);
    total += weight;
  }
  bool known = total > 0.0;
  slope *= 2.0;
  imageStore(half_guide, texel, first);
  imageStore(half_slope, texel, vec4(slope, 0.0, 0.0));
  imageStore(packed_guide, texel,
             (known ? pack_guide(decode_guide(first)) : packed_background).xyxy);
  imageStore(packed_slope, texel, known ? pack_slope(slope, first.w) : vec4(0.0));
  float inverse = known ? 1.0 / total : 0.0;
  imageStore(half_signal, texel, sum * vec4(vec2(inverse), vec2(inverse * inverse)));
}
