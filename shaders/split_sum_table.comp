#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// The split-sum's second sum (Karis 2013): scale (x) and bias (y) of F0 over n.v and roughness.
#include "lib/brdf.glsl"

layout(set = 1, binding = 0, rg32f) writeonly uniform image2D table;
layout(push_constant) uniform Constants { uint samples; };

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(table);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 at = (vec2(texel) + 0.5) / vec2(size);
  float n_dot_v = at.x;
  float alpha = max(at.y * at.y, 1e-4);
  vec3 v = vec3(sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
  vec2 sum = vec2(0.0);
  for (uint i = 0u; i < samples; ++i) {
    vec2 u = vec2((float(i) + 0.5) / float(samples),
                  float(bitfieldReverse(i)) * 2.3283064365386963e-10);
    float cos_h = sqrt((1.0 - u.x) / (1.0 + (alpha * alpha - 1.0) * u.x));
    float sin_h = sqrt(max(0.0, 1.0 - cos_h * cos_h));
    float angle = 2.0 * pi * u.y;
    vec3 h = vec3(sin_h * cos(angle), sin_h * sin(angle), cos_h);
    float v_dot_h = dot(v, h);
    vec3 l = 2.0 * v_dot_h * h - v;
    if (l.z <= 0.0 || v_dot_h <= 0.0) continue;
    float weight = 4.0 * smith_visibility(l.z, n_dot_v, alpha) * l.z * v_dot_h / max(cos_h, 1e-6);
    float m = 1.0 - v_dot_h;
    float fresnel = m * m * m * m * m;
    sum += weight * vec2(1.0 - fresnel, fresnel);
  }
  imageStore(table, texel, vec4(sum / float(samples), 0.0, 0.0));
}
