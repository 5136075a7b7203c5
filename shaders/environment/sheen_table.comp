#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// What white sheen gives back of light from everywhere, over n.v and roughness: a sum over the
// half of the sky on one side of the eye.
#include "lib/lighting/brdf.glsl"

layout(set = 1, binding = 0, r32f) writeonly uniform image2D table;

const int steps = 48;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(table);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 at = (vec2(texel) + 0.5) / vec2(size);
  vec3 view = vec3(sqrt(1.0 - at.x * at.x), 0.0, at.x);
  float sum = 0.0;
  for (int i = 0; i < steps * steps; ++i) {
    float cosine = (float(i % steps) + 0.5) / float(steps);
    float angle = pi * (float(i / steps) + 0.5) / float(steps);
    float sine = sqrt(1.0 - cosine * cosine);
    vec3 light = vec3(sine * cos(angle), sine * sin(angle), cosine);
    float n_dot_h = normalize(view + light).z;
    sum += sheen_lobe(n_dot_h, cosine, at.x, at.y) * cosine;
  }
  imageStore(table, texel, vec4(2.0 * pi * sum / float(steps * steps), 0.0, 0.0, 0.0));
}
