#version 460
layout(local_size_x = 64, local_size_y = 1) in;
// Test shader with other workgroups than those of add.comp: sum = given + amount.
layout(set = 1, binding = 0, r32f) readonly uniform image2D given;
layout(set = 1, binding = 1, r32f) writeonly uniform image2D sum;
layout(push_constant) uniform Constants { float amount; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(sum)))) return;
  imageStore(sum, pixel, vec4(imageLoad(given, pixel).r + amount));
}
