#version 460
layout(local_size_x = 8, local_size_y = 8) in;
// The least a pass over an image can do: one load and one store a pixel.
layout(set = 1, binding = 0, rgba32f) readonly uniform image2D source;
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2D copy;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(copy)))) return;
  imageStore(copy, pixel, imageLoad(source, pixel));
}
