#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require

#include "shared/ray.h"

layout(location = 0) rayPayloadInEXT Hit payload;
hitAttributeEXT vec2 barycentric;

void main() {
  payload = Hit(gl_HitTEXT, uint(gl_InstanceID), uint(gl_PrimitiveID), barycentric.x,
              barycentric.y, 0u, 0u, 0u);
}
