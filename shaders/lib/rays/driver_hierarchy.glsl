// What every stage knows that traces through the driver's own hierarchy.
#ifndef HELIOGRAPH_LIB_DRIVER_HIERARCHY_GLSL
#define HELIOGRAPH_LIB_DRIVER_HIERARCHY_GLSL

#include "lib/math/nearest_texel.glsl"
#include "lib/rays/ray_blending.glsl"

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

// The mask's alpha, of 255, at barycentric (u, v) of the triangle.
uint mask_alpha(RayMask mask, uint triangle, vec2 barycentric) {
  if (mask.width == 0u) return 255u;
  const uint corner = mask.first_uv + 3u * triangle;
  const vec2 uv = (1.0 - barycentric.x - barycentric.y) * mask_uvs[corner] +
                  barycentric.x * mask_uvs[corner + 1u] + barycentric.y * mask_uvs[corner + 2u];
  const uint offset = mask.texels + nearest_texel(uv, uvec2(mask.width, mask.height),
                                                  uvec2(mask.wrap_s, mask.wrap_t));
  const uint word = texelFetch(alpha_heap, int(offset >> 2)).x;
  return bitfieldExtract(word, int(8u * (offset & 3u)), 8);
}

// Whether the masked instance lets a ray through barycentric (u, v) of its triangle end there.
// `blending` is the ray's own.
bool mask_stops(uint instance, uint triangle, vec2 barycentric, uint blending) {
  const RayMask mask = masks[mask_of_instance[instance]];
  return alpha_stops(mask_alpha(mask, triangle, barycentric), mask.limit, blending, instance,
                     triangle);
}

#endif
