#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The split-sum's second sum (Karis 2013): scale (x) and bias (y) of F0 over n.v and roughness, as
// the mean weight of the samples that specular rays draw.
#include "lib/math/sampling.glsl"

layout(set = 1, binding = 0, rg32f) writeonly uniform image2D table;
layout(push_constant) uniform Constants { uint samples; };

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(table);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 at = (vec2(texel) + 0.5) / vec2(size);
  float alpha = at.y * at.y;
  vec3 view = vec3(sqrt(1.0 - at.x * at.x), 0.0, at.x);
  vec2 sum = vec2(0.0);
  for (uint i = 0u; i < samples; ++i) {
    vec2 u = vec2((float(i) + 0.5) / float(samples),
                  (float(bitfieldReverse(i) >> 8u) + 0.5) * exp2(-24.0));
    vec3 normal = sample_visible_normal(view, alpha, u);
    vec3 light = reflect(-view, normal);
    float m = 1.0 - dot(view, normal);
    float f90_minus_f0 = m * m * m * m * m;
    sum += visible_normal_weight(view, light, alpha) * vec2(1.0 - f90_minus_f0, f90_minus_f0);
  }
  imageStore(table, texel, vec4(sum / float(samples), 0.0, 0.0));
}
