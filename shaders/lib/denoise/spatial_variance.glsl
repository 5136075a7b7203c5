// A history too short to tell its variance takes that of its neighbours on the same surface (Schied
// et al. 2017, section 4.2), raised while it is short. A pixel that has no such neighbours, as
// along the rim of a column, would show its single rays as they are, for no filter reaches it: it
// takes its mean, too, from what lies about as far away, while its history is short. What a signal
// and its history are comes from the shader that includes this.
#include "lib/denoise/edge_stopping.glsl"
#include "lib/denoise/guide.glsl"
#include "lib/frame.glsl"
#include "lib/denoise/reprojection.glsl"
#include "lib/rays/gathered_pixels.glsl"
#include "shared/denoise.h"

/// What the next frame goes on from.
void keep(ivec2 pixel, vec4 value);

const float enough_neighbours = 8.0;  // the pixel itself counts as one
const float nearby_depth = 0.02;      // of the distance

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 1, binding = 0) uniform sampler2D guide;
layout(set = 1, binding = 1) uniform sampler2D depth_slope;
layout(set = 1, binding = 2) uniform sampler2D moments;
layout(set = 1, binding = 3) uniform sampler2D history;
layout(set = 1, binding = 4, rgba32f) uniform image2D signal;
layout(push_constant) uniform Constants { TemporalConstants constants; };

const int radius = 3;

bool has_short_history(ivec2 pixel) {
  if (outside_frame(pixel) || guide_is_background(texelFetch(guide, pixel, 0))) return false;
  vec2 frames = frames_of(texelFetch(history, pixel, 0));
  return min(frames.x, frames.y) < constants.spatial_variance_frames;
}

void main() {
  ivec2 own = ivec2(gl_GlobalInvocationID.xy);
  gather_pixel(has_short_history(own), own);
  if (!has_gathered_pixel()) return;
  ivec2 pixel = gathered_pixel();
  Guide here = decode_guide(texelFetch(guide, pixel, 0));
  vec2 frames = frames_of(texelFetch(history, pixel, 0));
  vec2 slope = texelFetch(depth_slope, pixel, 0).xy;
  float curve = enabled(frame_orthographic) ? 0.0 : 1.0 / max(here.view_z, 1e-20);
  float footprint = pixel_footprint(here.view_z);
  vec4 sum = vec4(0.0), loose_sum = vec4(0.0);
  float total = 0.0, loose_total = 0.0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      ivec2 tap = pixel + ivec2(x, y);
      if (!inside(tap, ivec2(frame.extent))) continue;
      vec4 guide_q = texelFetch(guide, tap, 0);
      if (guide_is_background(guide_q)) continue;
      Guide there = decode_guide(guide_q);
      vec2 offset = vec2(x, y);
      vec4 moments_there = moments_of(texelFetch(moments, tap, 0));
      float cosine = dot(here.normal, there.normal);
      float off_plane = plane_distance(here.view_z, slope, curve, there.view_z, offset);
      float weight =
          edge_weight(depth_exponent(off_plane, depth_allowance(slope, offset, footprint), 1.0) +
                      normal_exponent(cosine, 128.0));
      sum += weight * moments_there;
      total += weight;
      float apart = abs(there.view_z - here.view_z);
      float loose_weight =
          edge_weight(depth_exponent(apart, here.view_z, nearby_depth)) * max(cosine, 0.0);
      loose_sum += loose_weight * moments_there;
      loose_total += loose_weight;
    }
  }
  if (total <= 0.0) return;
  float alone = clamp((enough_neighbours - total) / (enough_neighbours - 2.0), 0.0, 1.0);
  sum = mix(sum / total, loose_sum / max(loose_total, 1e-6), alone);
  vec2 longer = max(constants.spatial_variance_frames / max(frames, vec2(1.0)), vec2(1.0));
  vec2 variance = max(second_moment(sum) - first_moment(sum) * first_moment(sum), vec2(0.0));
  variance *= longer;
  if ((constants.flags & temporal_mean_variance) != 0u) variance /= max(frames, vec2(1.0));
  vec4 value = with_mean(imageLoad(signal, pixel), first_moment(sum),
                         alone / max(frames, vec2(1.0)));
  value = with_variance(value, max(variance, variance_of(value)));
  imageStore(signal, pixel, value);
  keep(pixel, value);
}
