// What every stage knows that traces through the driver's own hierarchy.
#ifndef HELIOGRAPH_LIB_DRIVER_HIERARCHY_GLSL
#define HELIOGRAPH_LIB_DRIVER_HIERARCHY_GLSL

#include "lib/nearest_texel.glsl"
#include "shared/ray.h"
#include "shared/ray_mask.h"

layout(set = 1, binding = 0, std430) readonly buffer Count { RayCount ray_count; };
layout(set = 1, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, std430) readonly buffer MaskNumbers { uint mask_of_instance[]; };
layout(set = 1, binding = 3, std430) readonly buffer Masks { RayMask masks[]; };
layout(set = 1, binding = 4, std430) readonly buffer MaskUvs { vec2 mask_uvs[]; };
layout(set = 1, binding = 5) uniform usamplerBuffer alpha_heap;

// Address of the top level.
layout(push_constant) uniform Constants { uvec2 hierarchy; };

// Rays that the driver may be given: anything else is undefined there, and misses here.
bool traceable(Ray ray) {
  return ray.t_min < ray.t_max && dot(ray.direction, ray.direction) > 0.0 &&
         all(lessThan(abs(ray.origin), vec3(1e30)));
}

Hit miss(Ray ray) { return Hit(ray.t_max, hit_none, 0u, 0.0, 0.0, 0u, 0u, 0u); }

// Whether the masked instance lets a ray through barycentric (u, v) of its triangle end there.
bool mask_stops(uint instance, uint triangle, vec2 barycentric) {
  const RayMask mask = masks[mask_of_instance[instance]];
  const uint corner = mask.first_uv + 3u * triangle;
  const vec2 uv = (1.0 - barycentric.x - barycentric.y) * mask_uvs[corner] +
                  barycentric.x * mask_uvs[corner + 1u] + barycentric.y * mask_uvs[corner + 2u];
  const uint offset = mask.texels + nearest_texel(uv, uvec2(mask.width, mask.height),
                                                  uvec2(mask.wrap_s, mask.wrap_t));
  const uint word = texelFetch(alpha_heap, int(offset >> 2)).x;
  return bitfieldExtract(word, int(8u * (offset & 3u)), 8) >= mask.threshold;
}

#endif
