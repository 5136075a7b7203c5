#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
// Rays from a texel of the ground toward points of lights: all light in equal shares over time, so
// that their means converge to the light that arrives over that which is sent.
#include "lib/frame.glsl"
#include "lib/math/random.glsl"
#include "lib/rays/ray_index.glsl"
#include "lib/rays/stored_rays.glsl"
#include "shared/ground.h"

layout(set = 1, binding = 0, std430) readonly buffer Lights { GroundLight ground_light[]; };
layout(set = 1, binding = 1, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 2, std430) writeonly buffer Rays { StoredRay rays[]; };

/// How much of its weight a light with a place sends along `direction` to a surface `away` metres
/// from it.
float falloff(GroundLight light, vec3 direction, float away) {
  float squared = away * away;
  float share = max(direction.y, 0.0) / squared;
  if (light.range > 0.0) {
    float q = squared / (light.range * light.range);
    share *= clamp(1.0 - q * q, 0.0, 1.0);
  }
  float cone = clamp(-dot(light.axis, direction) * light.scale + light.offset, 0.0, 1.0);
  return share * (light.kind == ground_light_area ? cone : cone * cone);
}

void main() {
  uint texel = gl_GlobalInvocationID.x;
  if (texel >= ground_side * ground_side) return;
  if (texel == 0u) {
    ray_count = full_stream(ground_side * ground_side * ground_rays, ray_count.blending);
  }
  uint first = first_ground_light(texel);
  for (uint i = 0u; i < ground_rays; ++i) {
    uint number = frame.sample_index * ground_rays + i;
    GroundLight light = ground_light[(first + number * ground_light_step) % ground_lights];
    vec2 within = vec2(pcg3d(uvec3(texel, frame.seed, number + 1u)).xy >> 8u) * exp2(-24.0);
    vec2 corner = vec2(texel % ground_side, texel / ground_side);
    vec2 at = (corner + within) * (2.0 / float(ground_side)) - 1.0;
    Ray ray;
    ray.origin = frame.ground.xyz + frame.ground.w * vec3(at.x, 1e-5, at.y);
    ray.t_min = 0.0;
    ray.direction = light.place;
    ray.t_max = 1e30;
    float weight = light.weight;
    if (light.kind != ground_light_far) {
      vec3 to_light = light.place - ray.origin;
      float away = max(length(to_light), 1e-4);
      ray.direction = to_light / away;
      ray.t_max = away * 0.999;
      weight *= falloff(light, ray.direction, away);
    }
    // Without light there is nothing to find.
    if (weight <= 0.0) ray.t_max = 0.0;
    ray.pixel = texel;
    ray.user = floatBitsToUint(max(weight, 0.0));
    ray.padding0 = ray.padding1 = 0u;
    rays[texel * ground_rays + i] = stored(ray);
  }
}
