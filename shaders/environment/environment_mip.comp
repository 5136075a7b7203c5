#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// One level of a cube map from the level above it, the mean of four texels.
layout(set = 1, binding = 0, rgba32f) readonly uniform image2DArray above;
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2DArray below;

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel.xy, imageSize(below).xy))) return;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    sum += imageLoad(above, ivec3(texel.xy * 2 + ivec2(i & 1, i >> 1), texel.z));
  }
  imageStore(below, texel, sum * 0.25);
}
