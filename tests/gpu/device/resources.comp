#version 460
layout(local_size_x = 4, local_size_y = 2, local_size_z = 3) in;
// Test shader: one resource of every kind, out of order.
layout(set = 1, binding = 7, std430) buffer Both { uint both[]; };
layout(set = 1, binding = 2, rgba16f) writeonly uniform image2D half_image;
layout(set = 1, binding = 3) uniform sampler2D sampled;
layout(set = 1, binding = 1, std430) readonly buffer Table { vec4 table[]; };
layout(set = 1, binding = 5, std430) writeonly buffer Result { float result[]; };
layout(set = 0, binding = 4, std140) uniform Block { vec4 block; };
layout(push_constant) uniform Constants { vec4 first; uint second; };

void main() {
  result[0] = table[0].x + block.x + first.x + float(second) + float(both[0]);
  both[1] = 1u;
  imageStore(half_image, ivec2(0), texture(sampled, vec2(0.5)));
}
