#version 460
layout(local_size_x = 8, local_size_y = 8) in;
// Test shader: counted = given, whose texels are integers.
layout(set = 1, binding = 0) uniform usampler2D given;
layout(set = 1, binding = 1, r32f) writeonly uniform image2D counted;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(counted)))) return;
  imageStore(counted, pixel, vec4(float(texelFetch(given, pixel, 0).r)));
}
