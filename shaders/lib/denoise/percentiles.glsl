// The spread of each tile's brightness: its tenth and ninetieth percentile, by counting for every
// pixel how many lie below (Alber 2025). What brightness is comes from the shader that includes
// this. Background pixels do not count.
#include "lib/denoise/guide.glsl"
#include "lib/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 0, rgba32f) readonly uniform image2D guide;
layout(set = 1, binding = 1) uniform sampler2D raw;
layout(set = 1, binding = 2, rgba32f) writeonly uniform image2D percentiles;  // low, high; of either

shared vec2 values[64];
shared vec4 result;

const float nothing = 3e38;

/// Whether value `j` comes before value `i` in order; equal values by index.
uint before(float a, float b, uint i, uint j) { return b < a || (b == a && j < i) ? 1u : 0u; }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  uint mine = gl_LocalInvocationIndex;
  bool valid = !outside_frame(pixel) && !guide_is_background(imageLoad(guide, pixel));
  vec2 value = vec2(nothing);
  if (valid) {
    vec4 texel = texelFetch(raw, pixel, 0);
    bool bad = any(isnan(texel)) || any(isinf(texel));
    value = bad ? vec2(0.0) : brightness(texel);
  }
  values[mine] = value;
  if (mine == 0u) result = vec4(0.0);
  barrier();
  uvec2 rank = uvec2(0u);
  uint known = 0u;
  for (uint j = 0u; j < 64u; ++j) {
    vec2 other = values[j];
    rank += uvec2(before(value.x, other.x, mine, j), before(value.y, other.y, mine, j));
    known += other.x < nothing ? 1u : 0u;
  }
  uint low = (max(known, 1u) - 1u) / 10u;
  uint high = max(known, 1u) - 1u - low;
  if (valid) {
    if (rank.x == low) result.x = value.x;
    if (rank.x == high) result.y = value.x;
    if (rank.y == low) result.z = value.y;
    if (rank.y == high) result.w = value.y;
  }
  barrier();
  if (mine == 0u) imageStore(percentiles, ivec2(gl_WorkGroupID.xy), result);
}
