#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// A shadow ray toward a point of an emissive triangle for every pixel that has gathered indirect
// light, with the light that it adds.
#include "lib/frame.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/ray_stream.glsl"
#include "lib/math/geometry.glsl"
#include "lib/rays/stored_rays.glsl"
#include "shared/emissive.h"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, rgba32f) readonly uniform image2D radiance;
layout(set = 1, binding = 3, std430) readonly buffer Points { EmissivePoint points[]; };
layout(set = 1, binding = 4, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 5, std430) writeonly buffer Rays { StoredRay rays[]; };
#include "lib/lighting/emissive_choice.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool requested = false;
  Ray ray;
  float view_z = outside_frame(pixel) ? 0.0 : imageLoad(motion, pixel).w;
  if (view_z > 0.0 && imageLoad(radiance, pixel).w >= 0.0) {
    vec4 encoded = imageLoad(normals, pixel);
    vec3 geometric = octahedral_decode(encoded.zw);
    vec3 position = world_position(pixel, view_z);
    vec2 u = random_pair(uvec2(pixel), frame.sample_index, 8u, frame.seed);
    EmissiveChoice choice =
        choose_emissive(position, octahedral_decode(encoded.xy), geometric, u.x, u.y);
    requested = choice.total > 0.0;
    ray.origin = offset_origin(position, geometric, view_z);
    ray.t_min = 0.0;
    ray.direction = choice.direction;
    ray.t_max = choice.distance * 0.999;
    ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
    ray.user = floatBitsToUint(choice.light.r);
    ray.padding0 = floatBitsToUint(choice.light.g);
    ray.padding1 = floatBitsToUint(choice.light.b);
  }
  APPEND_RAY(requested, ray)
}
