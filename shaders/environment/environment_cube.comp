#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// Equirectangular environment -> cube map, four samples a texel.
#include "lib/math/equirectangular.glsl"

layout(set = 1, binding = 0) uniform sampler2D environment;
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2DArray cube;

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  int size = imageSize(cube).x;
  if (any(greaterThanEqual(texel.xy, ivec2(size)))) return;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec3 part = ivec3(texel.xy * 2 + ivec2(i & 1, i >> 1), texel.z);
    vec3 direction = cube_direction(part, float(size * 2));
    sum += textureLod(environment, equirectangular_uv(direction), 0.0).rgb;
  }
  imageStore(cube, texel, vec4(sum * 0.25, 1.0));
}
