#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
// One shadow ray per pixel toward one light, chosen in proportion to its unshadowed light there,
// so that the expected visibility is the ratio sum(L V) / sum(L) (Heitz et al. 2018).
#include "lib/lights.glsl"
#include "lib/octahedral.glsl"
#include "lib/random.glsl"
#include "lib/ray_stream.glsl"
#include "lib/geometry.glsl"

layout(set = 1, binding = 0, rgba32f) readonly uniform image2D normals;
layout(set = 1, binding = 1, rgba32f) readonly uniform image2D motion;
layout(set = 1, binding = 2, std430) buffer Count { RayCount ray_count; };
layout(set = 1, binding = 3, std430) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 4, r32f) writeonly uniform image2D visibility;

/// Weight of a light at a surface: its unshadowed irradiance, as far as both normals agree.
float light_weight(Light light, vec3 position, vec3 shading, vec3 geometric) {
  LightSample s = light_at(light, position);
  if (dot(geometric, s.direction) <= 0.0) return 0.0;
  return luminance(s.irradiance) * max(dot(shading, s.direction), 0.0);
}

/// A direction toward a point of the light's disk, and how far to trace.
Ray shadow_ray(Light light, vec3 position, vec3 geometric, float view_z, vec2 u) {
  LightSample s = light_at(light, position);
  float spread = light.radius;
  if (light.type == light_directional && frame.exposure.z >= 0.0) spread = frame.exposure.z;
  if (light.type != light_directional) spread /= s.distance;
  vec3 tangent, bitangent;
  orthonormal_basis(s.direction, tangent, bitangent);
  vec2 disk = sample_disk(u) * spread;
  vec3 direction = normalize(s.direction + tangent * disk.x + bitangent * disk.y);
  Ray ray;
  ray.origin = offset_origin(position, geometric, view_z);
  ray.t_min = 0.0;
  ray.direction = direction;
  ray.t_max = s.distance;
  ray.pixel = 0u;
  ray.user = 0u;
  ray.padding0 = 0u;
  ray.padding1 = 0u;
  return ray;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool wanted = false;
  Ray ray;
  float unshadowed = 0.0;
  float view_z = outside_frame(pixel) ? 0.0 : imageLoad(motion, pixel).w;
  if (view_z > 0.0) {
    vec4 encoded = imageLoad(normals, pixel);
    vec3 shading = octahedral_decode(encoded.xy);
    vec3 geometric = octahedral_decode(encoded.zw);
    vec3 position = world_position(pixel, view_z);
    float total = 0.0;
    uint chosen = 0u;
    float pick = random_number(uvec2(pixel), frame.extent.z, 1u, frame.extent.w);
    // Weighted reservoir of one: the pick is rescaled after every decision.
    for (uint i = 0u; i < frame.counts.x; ++i) {
      if (!reaches(lights[i], position)) continue;
      float weight = light_weight(lights[i], position, shading, geometric);
      if (weight <= 0.0) continue;
      total += weight;
      float share = weight / total;
      if (pick < share) {
        chosen = i;
        pick /= share;
      } else {
        pick = (pick - share) / (1.0 - share);
      }
    }
    if (total > 0.0) {
      unshadowed = 1.0;
      vec2 u = random_pair(uvec2(pixel), frame.extent.z, 2u, frame.extent.w);
      ray = shadow_ray(lights[chosen], position, geometric, view_z, u);
      ray.pixel = uint(pixel.x) | uint(pixel.y) << 16u;
      // The light's disk may reach below the horizon, where nothing of it is seen.
      wanted = dot(ray.direction, geometric) > 0.0;
      if (!wanted) unshadowed = 0.0;
    }
  }
  if (!outside_frame(pixel)) imageStore(visibility, pixel, vec4(unshadowed));
  APPEND_RAY(wanted, ray)
}
