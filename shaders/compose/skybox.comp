#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "lib/lighting/environment.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 1, rgba32f) writeonly uniform image2D background;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (outside_frame(pixel)) return;
  // 0 where a surface is: the memory of a new image is undefined.
  bool covered = imageLoad(motion, pixel).w > 0.0;
  vec3 radiance = covered ? vec3(0.0) : environment_background(-to_eye(pixel));
  imageStore(background, pixel, vec4(radiance, 1.0));
}
