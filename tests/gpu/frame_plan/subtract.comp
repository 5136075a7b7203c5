#version 460
layout(local_size_x = 8, local_size_y = 8) in;
// Test shader: difference = given - amount.
layout(set = 1, binding = 0, r32f) readonly uniform image2D given;
layout(set = 1, binding = 1, r32f) writeonly uniform image2D difference;
layout(push_constant) uniform Constants { float amount; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(difference)))) return;
  imageStore(difference, pixel, vec4(imageLoad(given, pixel).r - amount));
}
