#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Draws the points of emissive triangles that receivers of this frame choose from, one from each of
// as many equal parts of the table.
#define TEXTURE_ONE_LEVEL
#include "lib/lighting/emissive_lights.glsl"
#include "lib/math/random.glsl"

layout(set = 1, binding = 0, std430) writeonly buffer Points { EmissivePoint points[]; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  uvec3 first = pcg3d(uvec3(index, frame.sample_index, frame.seed * 2u));
  uvec3 second = pcg3d(uvec3(index, frame.sample_index, frame.seed * 2u + 1u));
  vec4 u = vec4(first.xy >> 8u, second.xy >> 8u) * exp2(-24.0);
  u.x = (float(index) + u.x) / float(emissive_points);
  Hit drawn = draw_emissive(u.xy, u.zw);
  RayCone cone = RayCone(0.0, 0.0);
  EmissiveSample at = emissive_sample(drawn, vec3(0.0), cone);
  vec3 front = emissive_sample(drawn, at.position + at.normal, cone).emission;
  vec3 back = emissive_sample(drawn, at.position - at.normal, cone).emission;
  points[index] = EmissivePoint(at.position, at.density, at.normal,
                                back == vec3(0.0) ? 0.0 : 1.0, front, 0.0);
}
