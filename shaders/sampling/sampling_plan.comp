#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Which pixels trace rays in this frame: those whose history is short do, the others in turn, the
// longer the history the more rarely.
#include "lib/frame.glsl"
#include "lib/math/random.glsl"
#include "shared/sampling.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D reprojection;
layout(set = 1, binding = 1, rgba8) readonly uniform image2D surface;
layout(set = 1, binding = 2, rgba16f) readonly uniform image2D visibility_length;  // one frame ago
layout(set = 1, binding = 3, rgba16f) readonly uniform image2D specular_length;    // one frame ago
layout(set = 1, binding = 4, rgba16f) readonly uniform image2D specular_distance;  // w, one frame ago
layout(set = 1, binding = 5, rgba16) readonly uniform image2D visibility;  // one frame ago
layout(set = 1, binding = 6, rgba16f) readonly uniform image2D indirect_length;  // one frame ago
layout(set = 1, binding = 7, r32ui) writeonly uniform uimage2D planned;
layout(push_constant) uniform Constants { SamplingPlanConstants constants; };

/// Place of a pixel in the order in which pixels take turns: any half of the turns, in sequence, is
/// about a checkerboard of the last one.
uint turn_of(uvec2 pixel) {
  uint odd = (pixel.x ^ pixel.y) & 1u;
  uint across = pixel.x & 1u;
  uint within = ((pixel.x ^ pixel.y) >> 1u) & 1u;
  return odd << 2u | across << 1u | within;
}

/// Whether a pixel has its turn, once in `frames`.
bool has_turn(uint turn, uint frames) { return (turn % plan_turns) * frames < plan_turns; }

/// The same with twice as many turns, for indirect light.
uint fine_turn(uvec2 pixel) {
  return turn_of(pixel) << 1u | ((pixel.x >> 1u ^ pixel.y >> 2u) & 1u);
}

bool has_ambient_turn(uvec2 pixel, uint turn, uint frames) {
  if (constants.indirect_side == 0u) return has_turn(turn, frames);
  uint fine = fine_turn(pixel) + (frame.sample_index * plan_step >> 28u);
  return (fine % (2u * plan_turns)) * frames < 2u * plan_turns;
}

/// Whether a surface with a history of `frames` is sampled when `turn` is its place in this frame.
bool is_sampled(float frames, uint most, uint turn) {
  return frames < constants.full_frames || has_turn(turn, most);
}

/// Whether a reflection that would be sampled traces no ray, because it is rough. Metals show most
/// of their reflection.
bool is_faded(vec4 material, ivec2 pixel) {
  float fraction = clamp((material.x - constants.fade_start) * constants.fade_slope, 0.0, 1.0) *
                   constants.fade_fraction * (1.0 - material.y);
  return random_number(uvec2(pixel), frame.sample_index, 7u, frame.seed) < fraction;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  vec4 map = imageLoad(reprojection, pixel);
  // Of the four pixels about the position, the one that it lies in.
  ivec2 before = ivec2(floor(map.xy));
  ivec2 within = before - ivec2(floor(map.xy - 0.5));
  bool known = (uint(map.z) >> uint(within.x + 2 * within.y) & 1u) != 0u;
  uint turn = turn_of(uvec2(pixel)) + (frame.sample_index * plan_step >> 29u);
  bool ambient_turn = has_ambient_turn(uvec2(pixel), turn, constants.ambient_least);
  if (!known) {
    imageStore(planned, pixel, uvec4(ambient_turn ? plan_all : plan_all & ~plan_ambient));
    return;
  }
  vec2 frames = imageLoad(visibility_length, before).xy;
  vec4 visible = imageLoad(visibility, before);
  vec2 noise = visible.zw * frames;
  frames *= mix(vec2(1.0), vec2(plan_quiet_factor), lessThan(noise, vec2(plan_quiet_variance)));
  if (constants.indirect_side != 0u) {
    frames.y = imageLoad(indirect_length, before / int(constants.indirect_side)).x;
    frames.y *= indirect_frames_factor;
  }
  vec4 material = imageLoad(surface, pixel);
  bool mirrors = material.x < plan_smooth_roughness || material.y > plan_metallic;
  float reflected = imageLoad(specular_length, before).x * (mirrors ? 1.0 : plan_quiet_factor);
  uint most = mirrors ? constants.mirrors_most : constants.specular_most;

  uint word = floatBitsToUint(abs(imageLoad(specular_distance, before).w)) >> 16u;
  float open = traces_ambient(frame.flags) ? clamp(visible.y, 0.0, 1.0) : 1.0;
  word |= uint(open * plan_visibility_steps + 0.5) << plan_visibility_shift;
  if (is_sampled(frames.x, constants.shadows_most, turn)) word |= plan_shadows;
  if (ambient_turn && (frames.y < constants.full_frames ||
                       has_ambient_turn(uvec2(pixel), turn, constants.ambient_most))) {
    word |= plan_ambient;
  }
  if (is_sampled(reflected, most, turn + plan_turns / 2u)) {
    word |= is_faded(material, pixel) ? constants.faded : plan_specular;
  }
  imageStore(planned, pixel, uvec4(word));
}
