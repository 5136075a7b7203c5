#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Refit, first: the corners of triangles of deforming meshes where their vertices are now.
#include "shared/bvh.h"
#include "shared/refit.h"

layout(set = 1, binding = 0, std430) readonly buffer Positions { float positions[]; };
layout(set = 1, binding = 1, std430) readonly buffer Moved { RefitTriangle moved[]; };
layout(set = 1, binding = 2, std430) buffer Triangles { vec4 triangles[]; };
layout(push_constant) uniform Constants { uint count; };

vec3 position(uint vertex) {
  uint first = 3u * vertex;
  return vec3(positions[first], positions[first + 1u], positions[first + 2u]);
}

void main() {
  uint step = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += step) {
    RefitTriangle triangle = moved[i];
    uint texel = triangle.slot * bvh_texels_per_triangle;
    // The words beside the corners stay.
    triangles[texel].xyz = position(triangle.corner0);
    triangles[texel + 1u].xyz = position(triangle.corner1);
    triangles[texel + 2u].xyz = position(triangle.corner2);
  }
}
