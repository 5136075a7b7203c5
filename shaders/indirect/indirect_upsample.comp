#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Indirect light that was denoised at half the size, at full size (joint bilateral upsampling, Kopf
// et al. 2007): of the four texels about a pixel those of its surface.
#include "lib/denoise/edge_stopping.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/frame.glsl"
#include "shared/denoise.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 1, rg32f) readonly uniform image2D depth_slope;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D half_guide;
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D half_signal;
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D denoised;
layout(push_constant) uniform Constants { AtrousConstants constants; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec4 guide_p = imageLoad(guide, pixel);
  if (guide_is_background(guide_p)) {
    imageStore(denoised, pixel, vec4(0.0));
    return;
  }
  Guide p = decode_guide(guide_p);
  vec2 slope = imageLoad(depth_slope, pixel).xy;
  float curve = enabled(frame_orthographic) ? 0.0 : 1.0 / p.view_z;
  float footprint = pixel_footprint(p.view_z);
  ivec2 last = (ivec2(frame.extent) + 1) / 2 - 1;
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 side = 2 * ivec2(i & 1, i >> 1) - 1;
    ivec2 texel = (pixel + side) >> 1;
    if (any(lessThan(texel, ivec2(0))) || any(greaterThan(texel, last))) continue;
    vec4 guide_q = imageLoad(half_guide, texel);
    if (guide_is_background(guide_q)) continue;
    Guide q = decode_guide(guide_q);
    vec2 offset = vec2(2 * texel - pixel);
    // Bilinear: of two texels of half size the one that the pixel lies in weighs three quarters.
    vec2 nearness = mix(vec2(0.25), vec2(0.75), equal(texel, pixel >> 1));
    float of_surface =
        depth_exponent(plane_distance(p.view_z, slope, curve, q.view_z, offset),
                       abs(dot(slope, offset)) + footprint * max(0.5 * length(offset), 0.5),
                       constants.depth_sigma) +
        normal_exponent(dot(p.normal, q.normal), constants.normal_power);
    float weight = nearness.x * nearness.y * max(edge_weight(of_surface), upsample_least);
    sum += vec4(vec3(weight), weight * weight) * imageLoad(half_signal, texel);
    total += weight;
  }
  total = max(total, upsample_least);
  imageStore(denoised, pixel, sum / vec4(vec3(total), total * total));
}
