#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
// One cosine-distributed ray per pixel that asks whether the environment is hidden nearby.
#include "lib/frame.glsl"
#include "lib/math/octahedral.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/gathered_pixels.glsl"
#include "lib/rays/ray_stream.glsl"
#include "lib/math/geometry.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 3, std430) writeonly buffer Rays { StoredRay rays[]; };
layout(set = 1, binding = 4, r32ui) readonly uniform uimage2D planned;  // or anything
layout(set = 1, binding = 5, r32f) writeonly uniform image2D visibility;
layout(push_constant) uniform Constants { uint by_plan; };

#include "lib/rays/visibility_pixels.glsl"

void main() {
  ivec2 own = ivec2(gl_GlobalInvocationID.xy);
  gather_pixel(wants_ray(own, plan_ambient, 1.0), own);
  bool requested = false;
  Ray ray;
  if (has_gathered_pixel()) {
    ivec2 pixel = gathered_pixel();
    float view_z = imageLoad(motion, pixel).w;
    vec4 encoded = imageLoad(normals, pixel);
    vec3 shading = octahedral_decode(encoded.xy);
    vec3 geometric = octahedral_decode(encoded.zw);
    vec2 u = random_pair(uvec2(pixel), frame.sample_index, 3u, frame.seed);
    ray.origin = offset_origin(world_position(pixel, view_z), geometric, view_z);
    ray.t_min = 0.0;
    ray.direction = sample_cosine(shading, u);
    ray.t_max = frame.ambient_radius;
    ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
    ray.user = 0u;
    ray.padding0 = 0u;
    ray.padding1 = 0u;
    requested = dot(ray.direction, geometric) > 0.0;
    // Directions below the surface are hidden by it.
    leave(pixel, requested ? 1.0 : 0.0);
  }
  APPEND_RAY(requested, ray)
}
