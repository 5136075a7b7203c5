#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// What the device's own sampler makes of the same texture.
layout(set = 1, binding = 0, std430) readonly buffer Inputs { vec4 places[]; };
layout(set = 1, binding = 1) uniform sampler2D image;
layout(set = 1, binding = 2, std430) writeonly buffer Outputs { vec4 colors[]; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index < uint(places.length())) {
    colors[index] = textureLod(image, places[index].xy, places[index].z);
  }
}
