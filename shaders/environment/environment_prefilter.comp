#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// One roughness level of the split-sum's first sum (Karis 2013): N = V = R, GGX importance
// sampling weighted by n.l, each sample read from the level its solid angle covers.
#include "lib/lighting/brdf.glsl"
#include "lib/math/equirectangular.glsl"

layout(set = 1, binding = 0) uniform samplerCube source;
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2DArray filtered;
layout(push_constant) uniform Constants {
  float roughness;
  float source_size;
  uint samples;
};

vec2 hammersley(uint i, uint count) {
  return vec2((float(i) + 0.5) / float(count), float(bitfieldReverse(i)) * 2.3283064365386963e-10);
}

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  int size = imageSize(filtered).x;
  if (any(greaterThanEqual(texel.xy, ivec2(size)))) return;
  vec3 n = cube_direction(texel, float(size));
  vec3 tangent, bitangent;
  orthonormal_basis(n, tangent, bitangent);
  float alpha = roughness * roughness;
  float texel_solid_angle = 4.0 * pi / (6.0 * source_size * source_size);
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (uint i = 0u; i < samples; ++i) {
    vec2 u = hammersley(i, samples);
    float cos_h = sqrt((1.0 - u.x) / (1.0 + (alpha * alpha - 1.0) * u.x));
    float sin_h = sqrt(max(0.0, 1.0 - cos_h * cos_h));
    float angle = 2.0 * pi * u.y;
    vec3 h = tangent * (sin_h * cos(angle)) + bitangent * (sin_h * sin(angle)) + n * cos_h;
    vec3 l = 2.0 * cos_h * h - n;
    float n_dot_l = dot(n, l);
    if (n_dot_l <= 0.0) continue;
    float density = ggx_distribution(cos_h, alpha) / 4.0;  // n.h / (4 v.h) with v = n
    float sample_solid_angle = 1.0 / (float(samples) * density + 1e-6);
    float level = 0.5 * log2(sample_solid_angle / texel_solid_angle) + 1.0;
    sum += textureLod(source, l, max(level, 0.0)).rgb * n_dot_l;
    weights += n_dot_l;
  }
  imageStore(filtered, texel, vec4(sum / max(weights, 1e-6), 1.0));
}
